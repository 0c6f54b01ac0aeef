/** The replay page: reads the data and connects everything. */

import { Choice } from './curves/choice.js';
import { CurvesPanel } from './curves/panel.js';
import { readRun } from './data.js';
import { byId, element } from './element.js';
import { jointColour } from './joint-colours.js';
import { connectKeyboard } from './keyboard.js';
import { Kinematics } from './kinematics.js';
import { Layout } from './layout.js';
import { fillBanner } from './panels/banner.js';
import { EventsPanel } from './panels/events.js';
import { JointsPanel } from './panels/joints.js';
import { fillSummary } from './panels/summary.js';
import { Player } from './player.js';
import { ProgramPanel } from './program/panel.js';
import { Stage } from './scene/stage.js';
import { connectStatus } from './status.js';
import { Theme } from './theme.js';
import { Timeline } from './timeline.js';
import { connectTransport } from './transport.js';

const still = matchMedia('(prefers-reduced-motion: reduce)').matches;

function start() {
  const run = readRun(byId('irlx-data').textContent);
  const { data } = run;
  const small = data.small === true;
  const theme = new Theme();
  const player = new Player(run);
  const kinematics = new Kinematics(data.robot);
  fillHeader(run);
  fillBanner(byId('banner'), run);
  const colours = (index) => jointColour(index, theme.isDark);
  const choice = new Choice(run);
  const shared = { run, player, theme, choice, colours };
  const program = new ProgramPanel({ host: byId('program'), ...shared });
  new EventsPanel({ host: byId('events'), ...shared });
  fillSummary(byId('summary'), run);
  const joints = new JointsPanel({ host: byId('joints'), ...shared });
  const stage = makeStage(run, kinematics, theme);
  const layout = new Layout({
    small,
    program,
    events: run.events.length,
    fitted: (covered) => {
      if (!stage) return;
      stage.covered = covered;
      if (!stage.view.touched) stage.fit();
    },
  });
  const hover = (frame) => stage?.mark(frame);
  const curves = new CurvesPanel({ host: byId('curves'), hover, single: small, ...shared });
  for (const panel of [joints, curves]) panel.onJoint((axis) => stage?.hoverJoint(axis));
  new Timeline({ strip: byId('strip'), slider: byId('slider'), tip: byId('tip'), hover, ...shared });
  connectTransport(run, player);
  connectStatus(byId('status'), run, player);
  if (stage && run.count) player.onChange(() => stage.show(player));
  connectActions({ player, theme, stage, layout });
  const ready = stage ? stage.view.drawn() : Promise.resolve();
  window.irlx = api(run, player, kinematics, ready);
  begin(player, small);
}

/** The scene; where the browser cannot draw it, a sentence in its place. */
function makeStage(run, kinematics, theme) {
  try {
    return new Stage(byId('scene'), run, kinematics, theme, still);
  } catch (error) {
    const why = 'This browser draws no WebGL, so the robot cannot be shown. Everything else works.';
    byId('scene').prepend(element('p', { class: 'no-scene', title: String(error?.message ?? error) }, why));
    return null;
  }
}

function fillHeader(run) {
  const { data } = run;
  const count = data.summary.plain?.moves;
  const moves = count === undefined ? null : `${count} ${count === 1 ? 'move' : 'moves'}`;
  byId('title').textContent = data.title;
  byId('facts').replaceChildren(
    ...[data.robot.name, data.cell?.name, moves].filter(Boolean).map((fact) => element('span', {}, fact)),
  );
  const state = byId('state');
  state.textContent = data.complete ? 'complete' : 'incomplete';
  state.classList.add(data.complete ? 'good' : 'bad');
}

function connectActions({ player, theme, stage, layout }) {
  const help = () => byId('help').showModal();
  const fit = () => stage?.fit();
  const joints = () => layout.toggleJoints();
  byId('show-help').addEventListener('click', help);
  byId('help').addEventListener('click', (event) => {
    if (event.target === byId('help')) byId('help').close();
  });
  byId('fit').addEventListener('click', fit);
  byId('theme').addEventListener('click', () => theme.toggle());
  byId('show-joints').addEventListener('click', joints);
  connectKeyboard({ player, theme, fit, joints, help });
}

/** What the console, tests and other pages use. */
function api(run, player, kinematics, ready) {
  const { data } = run;
  return {
    ready,
    data,
    get frame() {
      return player.frame;
    },
    frames: run.count,
    seek: (frame) => {
      player.pause();
      player.seek(frame);
    },
    play: () => player.play(),
    pause: () => player.pause(),
    toolPose: (frame = player.frame) => {
      const tip = kinematics.poses(run.q(frame))[data.robot.tip];
      const { xyz, quat } = Kinematics.within(tip, run.tool(frame));
      return [...xyz, ...quat];
    },
  };
}

/** Play, unless the reader wants stillness or the address names a time, as in #t=3.5. */
function begin(player, small) {
  const asked = location.hash.match(/^#t=([\d.]+)$/);
  if (asked) {
    player.seekTime(Number(asked[1]));
    forgetTime(player);
  } else if (!still && !small) player.play();
}

/** Take the time out of the address as soon as another one is shown. */
function forgetTime(player) {
  const { frame } = player;
  let told = true;
  player.onChange(() => {
    if (!told || player.frame === frame) return;
    told = false;
    history.replaceState(history.state, '', location.pathname + location.search);
  });
}

try {
  start();
} catch (error) {
  byId('banner').hidden = false;
  byId('banner').append(element('p', {}, element('strong', {}, 'The page cannot show this run. '), String(error?.message ?? error)));
  window.irlx = { ready: Promise.reject(error) };
  throw error;
}
