/** Canvas, camera, lights and controls; draws only when something has changed. */

import {
  Color,
  DirectionalLight,
  HemisphereLight,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,

  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const FIELD = 38; // degrees of the camera, upright
const SLOW = 60; // ms between two pictures that are too many, ..
const PATIENCE = 12; // .. that often in turn

export class View {
  #asked = false;
  #last = 0;
  #slow = 0;
  #afterDrawing = [];
  #drawn = [];

  /** Begin to draw into the element `host`; throws where the browser has no WebGL. */
  constructor(host, still) {
    this.host = host;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, powerPreference: 'low-power' });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.canvas = this.renderer.domElement;
    this.canvas.setAttribute('aria-label', 'The robot. Drag to turn, wheel or pinch to zoom, right button to shift.');
    this.canvas.setAttribute('role', 'img');
    host.prepend(this.canvas);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELD, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = !still;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => {
      this.touched = true;
    });
    this.#addLights();
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  /** Draw the scene soon, once however often it is asked for. */
  draw() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame((now) => {
      this.#asked = false;
      this.#pace(now);
      // Movement that dies down asks for the next picture itself, by the 'change' event.
      this.controls.update();
      this.renderer.render(this.scene, this.camera);
      for (const listener of this.#afterDrawing) listener(this.camera);
      for (const done of this.#drawn.splice(0)) done();
    });
  }

  /** Give up shadows, then sharpness, where pictures one after the other take too long, as without a graphics card. */
  #pace(now) {
    const took = now - this.#last;
    this.#last = now;
    // A long break is a rest, not a slow picture.
    if (took > 500) return;
    this.#slow = took > SLOW ? this.#slow + 1 : 0;
    if (this.#slow < PATIENCE) return;
    this.#slow = 0;
    if (this.sun.castShadow) this.sun.castShadow = false;
    else if (this.renderer.getPixelRatio() > 0.75) this.renderer.setPixelRatio(Math.max(0.75, this.renderer.getPixelRatio() / 1.5));
  }

  /** A promise that is kept once the scene has been drawn anew. */
  drawn() {
    return new Promise((done) => {
      this.#drawn.push(done);
      this.draw();
    });
  }

  /** Call `listener(camera)` after each picture. */
  afterDrawing(listener) {
    this.#afterDrawing.push(listener);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height || (width === this.width && height === this.height)) return;
    this.width = width;
    this.height = height;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.onResize?.();
    this.draw();
  }

  /** Light what is within `radius` m of `centre` so that it throws a shadow. */
  lightUp(centre, radius) {
    const { sun } = this;
    sun.position.set(centre.x + radius * 0.9, centre.y - radius * 0.7, centre.z + radius * 2.4);
    sun.target.position.copy(centre);
    sun.target.updateMatrixWorld();
    const camera = sun.shadow.camera;
    Object.assign(camera, { left: -radius, right: radius, top: radius, bottom: -radius });
    Object.assign(camera, { near: radius * 0.2, far: radius * 5 });
    camera.updateProjectionMatrix();
    sun.shadow.normalBias = radius * 0.004;
  }

  /** Take the colours of the theme. */
  paint(theme) {
    this.sky.color = new Color(theme.isDark ? '#cfdcec' : '#ffffff');
    this.sky.groundColor = new Color(theme.isDark ? '#1c242e' : '#b9c0c8');
    this.sky.intensity = theme.isDark ? 1.25 : 1.5;
    this.sun.intensity = theme.isDark ? 2.1 : 2.0;
    this.draw();
  }

  #addLights() {
    this.sky = new HemisphereLight('#ffffff', '#b9c0c8', 1.7);
    this.sky.position.set(0, 0, 1);
    this.sun = new DirectionalLight('#ffffff', 2.2);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 4;
    const fill = new DirectionalLight('#dfe8ff', 0.6);
    fill.position.set(-1, 1, 0.4);
    this.scene.add(this.sky, this.sun, this.sun.target, fill);
  }
}

