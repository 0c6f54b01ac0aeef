/** The robot: its links in the colours of their shapes, tinted where a limit holds or an obstacle is near. */

import { Color, Group, Mesh, MeshStandardMaterial, Vector3 } from 'three';
import { turned } from '../quaternion.js';
import { cornersOf, geometryOf } from './shapes.js';

const TONES = ['#5c7f99', '#dfe4e8', '#3f6c8c', '#c3ccd3'];
const BLACK = new Color(0);

export class RobotModel {
  constructor(run, kinematics) {
    this.run = run;
    this.kinematics = kinematics;
    this.group = new Group();
    this.links = run.data.robot.links.map((link, number) => this.#linkGroup(link, number));
    /** Of each axis, the links that its joints carry. */
    this.carried = run.joints.map((_, axis) =>
      run.data.robot.links.flatMap((link, number) => (link.joint?.of === axis ? [number] : [])),
    );
    this.byName = new Map(run.data.robot.links.map((link, number) => [link.name, number]));
  }

  /** Put the links where axis values q put them; returns their poses. */
  pose(q) {
    const poses = this.kinematics.poses(q);
    poses.forEach((pose, number) => {
      this.links[number].position.set(...pose.xyz);
      this.links[number].quaternion.set(...pose.quat);
    });
    return poses;
  }

  /** Tint links: `tints` maps the number of a link to {colour, strength 0..1}, the others have their own colour. */
  tint(tints) {
    this.links.forEach((group, number) => {
      const { colour, strength } = tints.get(number) ?? { colour: BLACK, strength: 0 };
      for (const material of group.userData.materials) {
        material.color.copy(material.userData.own).lerp(colour, 0.8 * strength);
        material.emissive.copy(colour).multiplyScalar(0.35 * strength);
      }
    });
  }

  /** Points of the robot in posture q: corners of its shapes and places of its joints, as Vector3. */
  outline(q) {
    const found = [];
    this.kinematics.poses(q).forEach((pose, number) => {
      const at = (point) => turned(pose.quat, point).map((value, k) => value + pose.xyz[k]);
      found.push(new Vector3(...pose.xyz));
      for (const shape of this.run.data.robot.links[number].shapes)
        for (const corner of cornersOf(shape, this.run.data.meshes)) {
          const inLink = turned(shape.quat, corner).map((value, k) => value + shape.xyz[k]);
          found.push(new Vector3(...at(inLink)));
        }
    });
    return found;
  }

  #linkGroup(link, number) {
    const group = new Group();
    group.name = link.name;
    group.userData.materials = [];
    for (const shape of link.shapes) {
      const geometry = geometryOf(shape, this.run.data.meshes);
      if (!geometry) continue;
      const mesh = new Mesh(geometry, this.#material(group, shape.color ?? TONES[number % TONES.length], shape));
      mesh.position.set(...shape.xyz);
      mesh.quaternion.set(...shape.quat);
      mesh.castShadow = mesh.receiveShadow = shape.opacity === 1;
      group.add(mesh);
    }
    this.group.add(group);
    return group;
  }

  #material(group, colour, shape) {
    const material = new MeshStandardMaterial({ color: colour, roughness: 0.55, metalness: 0.08 });
    if (shape.opacity < 1) Object.assign(material, { transparent: true, opacity: shape.opacity });
    material.userData.own = material.color.clone();
    group.userData.materials.push(material);
    return material;
  }
}
