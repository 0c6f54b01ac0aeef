/** The scene of a run: robot, obstacles, trail, places, ground and camera. */

import { Box3, Color, Sphere, Vector3 } from 'three';
import { bestDirection, fitCamera } from './camera-fit.js';
import { Compass } from './compass.js';
import { Ground } from './ground.js';
import { Labels } from './labels.js';
import { cornersOfObstacle, ObstacleModel } from './obstacles.js';
import { RobotModel } from './robot.js';
import { Trail } from './trail.js';
import { Kinematics } from '../kinematics.js';
import { triad } from './triad.js';
import { View } from './view.js';

const STATUS = 34; // px at the top of the view, where the line in execution stands
const POSTURES = 16; // postures by which the camera is fitted

export class Stage {
  /** Begin to draw a run into the element `host`; throws where the browser has no WebGL. */
  constructor(host, run, kinematics, theme, still) {
    Object.assign(this, { run, theme });
    this.view = new View(host, still);
    this.robot = new RobotModel(run, kinematics);
    this.#measure();
    this.obstacles = run.data.obstacles.map((it) => new ObstacleModel(it, run.data.meshes, 4 * this.sphere.radius));
    this.trail = new Trail(run, 2 * this.sphere.radius);
    this.tool = triad(this.sphere.radius * 0.1);
    const floor = Math.min(0, ...this.outline.map((point) => point.z));
    this.ground = new Ground(this.sphere.center, this.sphere.radius, floor < -0.02 * this.sphere.radius ? floor : 0);
    this.view.scene.add(this.ground.group, this.robot.group, this.trail.group, this.tool);
    for (const obstacle of this.obstacles) this.view.scene.add(obstacle.group);
    this.#addNames();
    this.compass = new Compass(this.view);
    /** Size in px of what covers the upper left corner of the view. */
    this.covered = { width: 0, height: 0 };
    this.view.onResize = () => {
      if (!this.view.touched) this.fit();
    };
    this.hovered = null;
    theme.onChange(() => this.paint());
    this.paint();
    this.fit();
  }

  /** Show where the player is. */
  show(player) {
    const { run } = this;
    const poses = this.robot.pose(run.q(player.frame, player.share));
    put(this.tool, Kinematics.within(poses[run.data.robot.tip], run.tool(player.frame)));
    for (const { axes, place } of this.carried) put(axes, Kinematics.within(poses[place.link], place));
    this.trail.show(player.frame);
    for (const obstacle of this.obstacles) if (!obstacle.rests) obstacle.move(player.time);
    this.#tint(player.frame);
    this.view.draw();
  }

  /** Light the links that an axis carries, null for none. */
  hoverJoint(axis) {
    this.hovered = axis;
    this.#tint(this.shown ?? 0);
    this.view.draw();
  }

  /** Mark where the tool is in another frame, null for none. */
  mark(frame) {
    this.trail.mark(frame);
    this.view.draw();
  }

  /** Move the camera so that robot, trail and obstacles fill the view. */
  fit() {
    const { camera, controls } = this.view;
    const open = Math.tan((camera.fov * Math.PI) / 360);
    const [across, up] = [open * camera.aspect * 0.94, open * 0.94];
    const { width = 1, height = 1 } = this.view;
    const room = (share) => Math.max(0.25, 1 - 2 * share);
    const whole = { left: across, right: across, top: up * room(STATUS / height), bottom: up };
    // Beside what covers the corner, or below it: where the camera can come nearer.
    const beside = { ...whole, left: across * room(this.covered.width / width) };
    const below = { ...whole, top: up * room(Math.max(STATUS, this.covered.height) / height) };
    const [{ position, target }] = [beside, below]
      .map((slopes) => fitCamera(this.points, this.direction, slopes))
      .sort((a, b) => a.depth - b.depth);
    camera.position.copy(position);
    controls.target.copy(target);
    camera.near = this.sphere.radius / 100;
    camera.far = this.sphere.radius * 40;
    camera.updateProjectionMatrix();
    controls.minDistance = this.sphere.radius / 50;
    controls.maxDistance = this.sphere.radius * 15;
    controls.update();
    this.view.touched = false;
    this.view.draw();
  }

  paint() {
    this.ground.paint(this.theme);
    this.trail.paint(this.theme);
    this.tints = {
      limit: new Color(this.theme.colour('limit')),
      nearest: new Color(this.theme.colour('nearest')),
      hovered: new Color(this.theme.colour('accent')),
    };
    this.obstacleColour = this.theme.colour('obstacle');
    this.#tint(this.shown ?? 0);
    this.view.paint(this.theme);
  }

  /** What the camera is fitted to: postures over the run, the trail, and what stands around them. */
  #measure() {
    const { run } = this;
    const last = Math.max(run.count - 1, 0);
    const frames = Array.from({ length: POSTURES }, (_, k) => Math.round((k * last) / (POSTURES - 1)));
    this.outline = [...new Set(frames)].flatMap((frame) => this.robot.outline(this.#posture(frame)));
    const [x, y, z] = run.data.frames.tool;
    const every = Math.max(1, Math.floor(run.count / 400));
    const trail = run.ticks.flatMap((_, k) => (k % every ? [] : [new Vector3(x[k], y[k], z[k])]));
    const box = new Box3().setFromPoints([...this.outline, ...trail]);
    const room = box.clone().expandByScalar(box.getSize(new Vector3()).length() * 0.35);
    // A wall of a hall must not make the robot small: only what of it is near counts.
    const around = run.data.obstacles.flatMap((it) =>
      cornersOfObstacle(it, run.data.meshes).map((corner) => corner.clamp(room.min, room.max)),
    );
    this.points = [...this.outline, ...trail, ...around];
    this.sphere = new Box3().setFromPoints(this.points).getBoundingSphere(new Sphere());
    this.sphere.radius = Math.max(this.sphere.radius, 0.01);
    this.direction = bestDirection(this.outline, trail, around);
    this.view.lightUp(this.sphere.center, this.sphere.radius * 1.3);
  }

  #posture(frame) {
    return this.run.count ? this.run.q(frame) : this.run.joints.map(() => 0);
  }

  #addNames() {
    const labels = new Labels(this.view);
    for (const { group, obstacle } of this.obstacles) {
      const corners = obstacle.shapes.length ? cornersOfObstacle({ ...obstacle, trajectory: [] }, this.run.data.meshes) : [];
      const top = corners.length ? new Box3().setFromPoints(corners) : null;
      const middle = top ? top.getCenter(new Vector3()).setZ(top.max.z) : new Vector3(...obstacle.xyz);
      const offset = middle.sub(new Vector3(...obstacle.xyz));
      labels.add(obstacle.name, 'obstacle', () => group.position.clone().add(offset));
    }
    this.carried = [];
    for (const place of this.run.data.places) {
      const axes = triad(this.sphere.radius * 0.07, 0.75);
      if (place.link === undefined) put(axes, place);
      else this.carried.push({ axes, place });
      this.view.scene.add(axes);
      labels.add(place.name, 'place', () => axes.position);
    }
  }

  #tint(frame) {
    this.shown = frame;
    if (!this.run.count) return;
    const tints = new Map();
    const near = this.#nearPair(frame);
    for (const name of near.names)
      if (this.robot.byName.has(name)) tints.set(this.robot.byName.get(name), { colour: this.tints.nearest, strength: near.strength });
    for (const event of this.run.eventsAt(frame))
      if (event.kind === 'limit' && event.joint !== null)
        for (const link of this.robot.carried[event.joint]) tints.set(link, { colour: this.tints.limit, strength: 1 });
    if (this.hovered !== null)
      for (const link of this.robot.carried[this.hovered]) tints.set(link, { colour: this.tints.hovered, strength: 1 });
    this.robot.tint(tints);
    for (const model of this.obstacles) model.paint(this.obstacleColour, near.names.includes(model.obstacle.name));
  }

  /** Names of the nearest link and of what it is near to while that is felt, and how much: 1 at the margin. */
  #nearPair(frame) {
    const { frames, pairs, obstacles } = this.run.data;
    const [pair, clearance] = [pairs[frames.nearest[frame]], frames.clearance[frame]];
    const nothing = { names: [], strength: 0 };
    if (!pair || clearance === null) return nothing;
    const obstacle = obstacles.find((candidate) => candidate.name === pair.other);
    // Two links of the robot are near each other by its build; only a few margins away is that worth a colour.
    const influence = obstacle?.influence ?? 4 * pair.margin;
    if (clearance >= influence) return nothing;
    const share = (influence - clearance) / Math.max(influence - pair.margin, 1e-9);
    return { names: [pair.link, pair.other], strength: Math.min(1, Math.max(0.15, share)) };
  }
}

/** Place an object of the scene at a pose {xyz, quat}. */
function put(object, { xyz, quat }) {
  object.position.set(...xyz);
  object.quaternion.set(...quat);
}
