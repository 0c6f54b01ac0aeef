/** Writes page.js, page.css, page.html and LICENCES.txt to src/irlx/report/page, or to the folder that is named. */

import { copyFile, mkdir, readFile, writeFile } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { build } from 'esbuild';

const here = import.meta.dirname;
const target = resolve(process.argv[2] ?? join(here, '../src/irlx/report/page'));

const BUNDLED = [
  { name: 'three', file: 'node_modules/three/LICENSE' },
  { name: 'uplot', file: 'node_modules/uplot/LICENSE' },
];

async function licences() {
  const parts = [];
  for (const { name, file } of BUNDLED) {
    const { version } = JSON.parse(await readFile(join(here, `node_modules/${name}/package.json`), 'utf8'));
    const text = (await readFile(join(here, file), 'utf8')).trim();
    parts.push(`${name} ${version}\n\n${text}\n`);
  }
  return `The replay page contains the following software.\n\n${parts.join(`\n${'-'.repeat(72)}\n\n`)}`;
}

const notices = await licences();
await mkdir(target, { recursive: true });
const shared = { bundle: true, minify: true, charset: 'utf8', logLevel: 'warning', legalComments: 'inline', absWorkingDir: here };
await build({
  ...shared,
  entryPoints: ['src/main.js'],
  outfile: join(target, 'page.js'),
  format: 'iife',
  target: 'es2022',
  banner: { js: `/*!\n${notices}*/` },
});
await build({ ...shared, entryPoints: ['src/page.css'], outfile: join(target, 'page.css'), target: ['chrome111', 'firefox113', 'safari16.4'] });
await copyFile(join(here, 'src/page.html'), join(target, 'page.html'));
await writeFile(join(target, 'LICENCES.txt'), notices);
