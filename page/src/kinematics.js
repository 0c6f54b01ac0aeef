/** Forward kinematics in doubles: joint values to poses of all links. */

import { aboutAxis, product, turned } from './quaternion.js';

const STILL = { xyz: [0, 0, 0], quat: [0, 0, 0, 1] };

export class Kinematics {
  /** `robot` as in the data: links, parents before children, each with the joint that carries it. */
  constructor(robot) {
    this.links = robot.links;
  }

  /** Value of a link's joint (rad or m) for axis values q; 0 of the root. */
  value(link, q) {
    const { joint } = this.links[link];
    if (!joint) return 0;
    return joint.of === null ? joint.offset : joint.multiplier * q[joint.of] + joint.offset;
  }

  /** Pose {xyz, quat} of every link in the world, for axis values q. */
  poses(q) {
    const found = [];
    this.links.forEach((link, number) => {
      const parent = link.parent < 0 ? STILL : found[link.parent];
      found.push(link.joint ? this.#child(parent, link.joint, this.value(number, q)) : parent);
    });
    return found;
  }

  /** Pose {xyz, quat} of a frame in the world that lies at `inner` {xyz, quat} in one at `outer`. */
  static within(outer, inner) {
    const way = turned(outer.quat, inner.xyz);
    return { xyz: outer.xyz.map((value, k) => value + way[k]), quat: product(outer.quat, inner.quat) };
  }

  #child(parent, joint, value) {
    const { xyz, quat } = Kinematics.within(parent, joint);
    if (joint.kind === 'revolute') return { xyz, quat: product(quat, aboutAxis(joint.axis, value)) };
    if (joint.kind === 'prismatic') {
      const way = turned(quat, joint.axis);
      return { xyz: [0, 1, 2].map((k) => xyz[k] + value * way[k]), quat };
    }
    return { xyz, quat };
  }
}
