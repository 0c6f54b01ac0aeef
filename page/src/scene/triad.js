/** Small axes, x red, y green, z blue, at the tool and at named places. */

import { CylinderGeometry, Group, Mesh, MeshBasicMaterial } from 'three';

const COLOURS = { x: '#d9403a', y: '#3c9f4b', z: '#3f73d8' };

/** Axes of a length in m; `opacity` below 1 for those that stand back. */
export function triad(length, opacity = 1) {
  const group = new Group();
  for (const [axis, colour] of Object.entries(COLOURS)) {
    const rod = new CylinderGeometry(length / 26, length / 26, length, 10);
    if (axis === 'x') rod.rotateZ(-Math.PI / 2);
    if (axis === 'z') rod.rotateX(Math.PI / 2);
    rod.translate(...['x', 'y', 'z'].map((name) => (name === axis ? length / 2 : 0)));
    group.add(new Mesh(rod, new MeshBasicMaterial({ color: colour, transparent: opacity < 1, opacity })));
  }
  return group;
}
