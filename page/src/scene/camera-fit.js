/** Where the camera stands so that points fill the view. */

import { Vector3 } from 'three';

const AZIMUTHS = 16;
const ELEVATIONS = [24, 58];
const USUAL = { azimuth: -60, elevation: 24 };

/** Unit vector from what is looked at to the camera; angles in degrees. */
function direction(azimuth, elevation) {
  const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
  return new Vector3(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e));
}

/** Axes of a view along -`toCamera`: to the right, up, to the camera. */
function viewAxes(toCamera) {
  const right = new Vector3(0, 0, 1).cross(toCamera).normalize();
  return [right, toCamera.clone().cross(right), toCamera];
}

/**
 * Direction from which movement is seen best: where postures, trail and what stands around spread widest,
 * the usual view from the front right being preferred unless another shows clearly more.
 */
export function bestDirection(postures, trail, around) {
  let [best, most] = [direction(USUAL.azimuth, USUAL.elevation), 0];
  for (const elevation of ELEVATIONS) {
    for (let k = 0; k < AZIMUTHS; k += 1) {
      const azimuth = USUAL.azimuth + (360 * k) / AZIMUTHS;
      const candidate = direction(azimuth, elevation);
      const usual = (elevation === USUAL.elevation ? 1.5 : 1) * (1 + 0.15 * Math.cos((2 * Math.PI * k) / AZIMUTHS));
      const seen = usual * (spread(postures, candidate) + 2 * spread(trail, candidate) + 0.5 * spread(around, candidate));
      if (seen > most) [best, most] = [candidate, seen];
    }
  }
  return best;
}

/** Area over which points spread in a view, m2: the root of the determinant of their covariance. */
function spread(points, toCamera) {
  const [right, up] = viewAxes(toCamera);
  let [n, sx, sy, sxx, sxy, syy] = [0, 0, 0, 0, 0, 0];
  for (const point of points) {
    const [x, y] = [point.dot(right), point.dot(up)];
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
  }
  if (!n) return 0;
  const [vx, vy, cov] = [sxx / n - (sx / n) ** 2, syy / n - (sy / n) ** 2, sxy / n - (sx * sy) / n ** 2];
  return Math.sqrt(Math.max(0, vx * vy - cov * cov));
}

/**
 * Target, place and depth (along `toCamera`, m) of a camera that looks along -`toCamera` and just sees all points.
 *
 * `slopes` {left, right, bottom, top}: how far the view opens to each side at distance 1. Each point bounds
 * the distance of the camera from below on each side; the shift that balances two opposite sides is best.
 */
export function fitCamera(points, toCamera, slopes) {
  const axes = viewAxes(toCamera);
  const sides = { left: -Infinity, right: -Infinity, bottom: -Infinity, top: -Infinity };
  let [near, far] = [-Infinity, Infinity];
  for (const point of points) {
    const [x, y, z] = axes.map((axis) => point.dot(axis));
    sides.right = Math.max(sides.right, x / slopes.right + z);
    sides.left = Math.max(sides.left, -x / slopes.left + z);
    sides.top = Math.max(sides.top, y / slopes.top + z);
    sides.bottom = Math.max(sides.bottom, -y / slopes.bottom + z);
    near = Math.max(near, z);
    far = Math.min(far, z);
  }
  const x = (sides.right - sides.left) / (1 / slopes.right + 1 / slopes.left);
  const y = (sides.top - sides.bottom) / (1 / slopes.top + 1 / slopes.bottom);
  const z = Math.max(sides.right - x / slopes.right, sides.top - y / slopes.top, near + 0.05 * (near - far));
  const middle = (near + far) / 2;
  const place = (depth) =>
    new Vector3().addScaledVector(axes[0], x).addScaledVector(axes[1], y).addScaledVector(axes[2], depth);
  return { position: place(z), target: place(middle), depth: z };
}
