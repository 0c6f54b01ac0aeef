/** Obstacles of the cell: translucent, with their edges and a hint of the margin kept clear around them. */

import {
  Color,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  PlaneGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import { between, turned } from '../quaternion.js';
import { cornersOf, geometryOf } from './shapes.js';

export class ObstacleModel {
  /** `size` of the scene, m: how large what has no end is drawn. */
  constructor(obstacle, meshes, size) {
    this.obstacle = obstacle;
    this.group = new Group();
    this.surface = new MeshStandardMaterial({ transparent: true, opacity: 0.26, roughness: 0.9, side: DoubleSide });
    this.surface.depthWrite = false;
    this.edge = new LineBasicMaterial({ transparent: true, opacity: 0.75 });
    this.plane = new MeshBasicMaterial({ transparent: true, opacity: 0.07, side: DoubleSide, depthWrite: false });
    this.hull = new MeshBasicMaterial({ transparent: true, opacity: 0.05, depthWrite: false });
    this.hullEdge = new LineBasicMaterial({ transparent: true, opacity: 0.28 });
    for (const shape of obstacle.shapes) this.#add(shape, meshes, size);
    this.move(0);
  }

  /** Put it where it is at a time, s. */
  move(time) {
    const { xyz, quat } = poseAt(this.obstacle, time);
    this.group.position.set(...xyz);
    this.group.quaternion.set(...quat);
  }

  /** Whether it stands still. */
  get rests() {
    return this.obstacle.trajectory.length < 2;
  }

  /** Take the colour of obstacles, stronger where the robot is `near`. */
  paint(colour, near = false) {
    for (const material of [this.surface, this.plane, this.edge, this.hull, this.hullEdge]) material.color = new Color(colour);
    this.surface.emissive = new Color(colour).multiplyScalar(0.35);
    this.plane.opacity = near ? 0.14 : 0.07;
    this.surface.opacity = near ? 0.34 : 0.2;
    this.edge.opacity = near ? 1 : 0.6;
    this.hullEdge.opacity = near ? 0.6 : 0.22;
  }

  #add(shape, meshes, size) {
    const part = new Group();
    part.position.set(...shape.xyz);
    part.quaternion.set(...shape.quat);
    if (shape.kind === 'halfspace') part.add(new Mesh(new PlaneGeometry(size, size), this.plane));
    else if (shape.kind === 'point') part.add(new Mesh(new SphereGeometry(size / 150, 16, 8), this.edge));
    const geometry = geometryOf(shape, meshes);
    if (geometry) {
      part.add(new Mesh(geometry, this.surface));
      part.add(new LineSegments(new EdgesGeometry(geometry, 40), this.edge));
    }
    const { margin } = this.obstacle;
    // A plane at some distance from a plane looks like a second obstacle.
    const grown = margin > 0 && shape.kind !== 'halfspace' ? marginHull(shape, meshes, margin) : null;
    if (grown) {
      part.add(new Mesh(grown, this.hull));
      part.add(new LineSegments(new EdgesGeometry(grown, 40), this.hullEdge));
    }
    this.group.add(part);
  }
}

function marginHull(shape, meshes, margin) {
  if (shape.kind === 'point') return new SphereGeometry(margin, 24, 12);
  return geometryOf(shape, meshes, margin);
}

/** Pose of an obstacle at a time: straight and evenly between waypoints, at rest outside of them. */
export function poseAt(obstacle, time) {
  const way = obstacle.trajectory;
  if (!way.length) return obstacle;
  let k = way.findIndex((point) => point.time > time);
  if (k < 0) k = way.length;
  if (k === 0 || k === way.length) return way[k ? k - 1 : 0];
  const [before, behind] = [way[k - 1], way[k]];
  const share = (time - before.time) / (behind.time - before.time);
  return {
    xyz: before.xyz.map((value, axis) => value + share * (behind.xyz[axis] - value)),
    quat: between(before.quat, behind.quat, share),
  };
}

/** Corners of an obstacle in the world as Vector3, along its whole way. */
export function cornersOfObstacle(obstacle, meshes) {
  const poses = obstacle.trajectory.length ? obstacle.trajectory : [obstacle];
  return poses.flatMap((pose) =>
    obstacle.shapes.flatMap((shape) =>
      cornersOf(shape, meshes).map((corner) => {
        const inObstacle = turned(shape.quat, corner).map((value, k) => value + shape.xyz[k]);
        return new Vector3(...turned(pose.quat, inObstacle).map((value, k) => value + pose.xyz[k]));
      }),
    ),
  );
}
