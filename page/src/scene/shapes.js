/** Shapes of the data -> geometries of three.js; lengths in m, axes of round shapes along z. */

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  ConeGeometry,
  CylinderGeometry,
  SphereGeometry,
} from 'three';
import { toCreasedNormals } from 'three/examples/jsm/utils/BufferGeometryUtils.js';

const ROUND = 40; // sides of what is round
const CREASE = (35 * Math.PI) / 180;

/** Geometry of a shape, `grown` m larger on all sides; null for one that has no surface of its own. */
export function geometryOf(shape, meshes, grown = 0) {
  const radius = (shape.radius ?? 0) + grown;
  switch (shape.kind) {
    case 'box':
      return new BoxGeometry(...shape.size.map((edge) => edge + 2 * grown));
    case 'sphere':
      return new SphereGeometry(radius, ROUND, ROUND / 2);
    case 'cylinder':
      return upright(new CylinderGeometry(radius, radius, shape.length + 2 * grown, ROUND));
    case 'capsule':
      return upright(new CapsuleGeometry(radius, shape.length, ROUND / 4, ROUND));
    case 'cone':
      return cone(shape, grown);
    case 'mesh':
      return grown > 0 ? null : meshGeometry(meshes[shape.mesh]);
    default:
      return null;
  }
}

/** three.js stands round shapes along y; here they stand along z. */
function upright(geometry) {
  return geometry.rotateX(Math.PI / 2);
}

/** The cone whose surface lies `grown` outside of the cone's: the same slope, a larger base. */
function cone(shape, grown) {
  const slant = Math.hypot(shape.radius, shape.length);
  const over = (grown * slant) / shape.radius; // how much higher the apex is
  const length = shape.length + grown + over;
  const geometry = upright(new ConeGeometry((length * shape.radius) / shape.length, length, ROUND));
  return geometry.translate(0, 0, (over - grown) / 2);
}

/** Geometry of each mesh, made once, with the box around it. */
const made = new WeakMap();

function meshGeometry(mesh) {
  if (!made.has(mesh)) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(bytes(mesh.vertices)), 3));
    const Numbers = mesh.index === 'u16' ? Uint16Array : Uint32Array;
    geometry.setIndex(new BufferAttribute(new Numbers(bytes(mesh.faces)), 1));
    const creased = toCreasedNormals(geometry, CREASE);
    creased.computeBoundingBox();
    made.set(mesh, creased);
  }
  return made.get(mesh);
}

function bytes(base64) {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer;
}

/** Corners of a shape's bounding box in its own frame, as [x, y, z]; none for what has no end. */
export function cornersOf(shape, meshes) {
  const half = halfSize(shape, meshes);
  if (!half) return [];
  const found = [];
  for (const x of [-1, 1]) for (const y of [-1, 1]) for (const z of [-1, 1]) found.push([x * half.x, y * half.y, z * half.z]);
  return half.centre ? found.map((corner) => corner.map((value, k) => value + half.centre[k])) : found;
}

function halfSize(shape, meshes) {
  const { radius, length } = shape;
  switch (shape.kind) {
    case 'box':
      return { x: shape.size[0] / 2, y: shape.size[1] / 2, z: shape.size[2] / 2 };
    case 'sphere':
      return { x: radius, y: radius, z: radius };
    case 'cylinder':
    case 'cone':
      return { x: radius, y: radius, z: length / 2 };
    case 'capsule':
      return { x: radius, y: radius, z: length / 2 + radius };
    case 'mesh': {
      const { min, max } = meshGeometry(meshes[shape.mesh]).boundingBox;
      const [x, y, z] = ['x', 'y', 'z'].map((k) => (max[k] - min[k]) / 2);
      return { x, y, z, centre: ['x', 'y', 'z'].map((k) => (max[k] + min[k]) / 2) };
    }
    case 'point':
      return { x: 0, y: 0, z: 0 };
    default:
      return null;
  }
}
