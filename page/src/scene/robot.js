/** The robot: its links in the colours of their shapes, tinted where a limit holds or an obstacle is near. */

import { Color, CylinderGeometry, Group, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from 'three';
import { turned } from '../quaternion.js';
import { cornersOf, geometryOf } from './shapes.js';

const TONES = ['#5c7f99', '#dfe4e8', '#3f6c8c', '#c3ccd3'];
const Z = new Vector3(0, 0, 1);

export class RobotModel {
  constructor(run, kinematics) {
    this.run = run;
    this.kinematics = kinematics;
    this.group = new Group();
    this.links = run.data.robot.links.map((link, number) => this.#linkGroup(link, number));
    this.bones = this.#bones();
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
    for (const bone of this.bones) bone.place(poses);
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

  #material(group, colour, shape = { opacity: 1 }) {
    const material = new MeshStandardMaterial({ color: colour, roughness: 0.55, metalness: 0.08 });
    if (shape.opacity < 1) Object.assign(material, { transparent: true, opacity: shape.opacity });
    material.userData.own = material.color.clone();
    group.userData.materials.push(material);
    return material;
  }

  /** Rods for links without shapes, so that an arm of bare frames can be seen, and for what slides. */
  #bones() {
    const { links } = this.run.data.robot;
    const size = this.#size();
    const bare = links.every((link) => link.shapes.length === 0);
    return links.flatMap((link, number) => {
      const parent = links[link.parent];
      if (!link.joint || !(bare || (!parent.shapes.length && parent.joint) || link.joint.kind === 'prismatic')) return [];
      return [new Bone(this, number, link.parent, bare || !parent.shapes.length ? size / 60 : size / 150)];
    });
  }

  /** Material of a rod that belongs to the link `owner`, tinted with it. */
  boneMaterial(owner, colour) {
    return this.#material(this.links[owner], colour);
  }

  #size() {
    const zero = this.run.count ? this.run.q(0) : this.run.joints.map(() => 0);
    const poses = this.kinematics.poses(zero);
    return poses.reduce((most, pose) => Math.max(most, Math.hypot(...pose.xyz.map((v, k) => v - poses[0].xyz[k]))), 0.1);
  }
}

const BLACK = new Color(0);

/** A rod from the frame of a link to that of its child. */
class Bone {
  constructor(robot, child, parent, radius) {
    this.child = child;
    this.parent = parent;
    const material = robot.boneMaterial(parent, TONES[parent % TONES.length]);
    this.rod = new Mesh(new CylinderGeometry(radius, radius, 1, 20).rotateX(Math.PI / 2), material);
    this.knob = new Mesh(new SphereGeometry(radius * 1.5, 20, 12), material);
    this.rod.castShadow = this.knob.castShadow = true;
    robot.group.add(this.rod, this.knob);
  }

  place(poses) {
    const [from, to] = [this.parent, this.child].map((number) => new Vector3(...poses[number].xyz));
    const way = to.clone().sub(from);
    const length = way.length();
    this.rod.visible = length > 1e-6;
    this.knob.position.copy(to);
    if (!this.rod.visible) return;
    this.rod.position.copy(from).addScaledVector(way, 0.5);
    this.rod.quaternion.setFromUnitVectors(Z, way.divideScalar(length));
    this.rod.scale.z = length;
  }
}
