// A visit by headset (WebXR): both eyes in one picture, walking by stick or by pointing, pages and captions in the room.
import {Room} from './room.js';

const kNear_m = 0.1, kFar_m = 900;
const kPushed = 0.6, kLetGo = 0.3, kSnap_rad = Math.PI / 6;
const kFloatsOfEye = 39;  // as of page_visit.h
const kUsualRate_hz = 72;
const kTold_ms = 100;

export class Headset {
  // follow: what the page does with the player's state some times a second.
  constructor(page, player, follow, wordsIn, signal) {
    Object.assign(this, {page, player, follow, wordsIn, signal, session: null});
    signal.addEventListener('abort', () => this.session?.end().catch(() => {}));
  }
  get isWorn() {
    return this.session !== null;
  }
  static async isThere() {
    return await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false) ?? false;
  }
  // After a click, as browsers want it. Throws what the browser says.
  async enter() {
    if (this.session) return this.session.end();
    const session = await navigator.xr.requestSession('immersive-vr', {requiredFeatures: ['local-floor'], optionalFeatures: ['hand-tracking']});
    const gl = this.player.module.GL.currentContext.GLctx;
    try {
      await gl.makeXRCompatible?.();
      this.layer = new XRWebGLLayer(session, gl, {antialias: false, depth: false, stencil: false, alpha: false});
      await session.updateRenderState({baseLayer: this.layer, depthNear: kNear_m, depthFar: kFar_m});
      this.space = await session.requestReferenceSpace('local-floor');
    } catch (e) {
      await session.end().catch(() => {});
      throw e;
    }
    Object.assign(this, {session, gl, room: this.room ?? new Room(gl), last: 0, told: 0, begun: false, aims: null, snaps: true, state: null,
                         pressed: new Map(), framebuffer: null, id: 0});
    session.addEventListener('end', () => this.#end());
    session.addEventListener('selectstart', (e) => this.#select(e.inputSource, true));
    session.addEventListener('selectend', (e) => this.#select(e.inputSource, false));
    this.page.dataset.headset = 'worn';
    session.requestAnimationFrame((now, frame) => this.#draw(now, frame));
  }

  #end() {
    this.session = null;
    this.player.do('page_take_off');
    this.player.do('page_sticks', ['number', 'number', 'number', 'number'], [0, 0, 0, 0]);
    delete this.page.dataset.headset;
    this.onEnd?.();
  }
  #draw(now, frame) {
    if (!this.session) return;
    this.session.requestAnimationFrame((later, next) => this.#draw(later, next));
    const pose = frame.getViewerPose(this.space);
    if (!pose) return;
    const {x, y, z} = pose.transform.position, passed_s = this.last ? Math.min(1, (now - this.last) / 1000) : 0;
    this.last = now;
    if (!this.begun) {
      this.player.do('page_put_on', ['number', 'number', 'number', 'number'], [x, y, z, this.session.frameRate || kUsualRate_hz]);
      this.begun = true;
    }
    const walks = this.#takeControllers(frame);
    try {
      this.#picture(pose, [x, y, z], passed_s);
    } catch (e) {
      this.onTrouble?.(e);
      return void this.session.end();
    }
    if (now - this.told > kTold_ms) {
      this.told = now;
      this.state = this.player.read('page_state');
      this.follow(this.state);
      this.room.show(this.state, pose);
    }
    this.room.draw(this.layer, pose, {walks, passed_s, rays: this.#rays(frame), landing: this.aims?.there ?? null,
                                      calm: this.state?.reduced_motion});
  }
  #picture(pose, head, passed_s) {
    const {module} = this.player, {GL} = module;
    if (this.layer.framebuffer !== this.framebuffer || this.id === 0) {
      this.framebuffer = this.layer.framebuffer;
      this.id = this.framebuffer ? GL.getNewId(GL.framebuffers) : 0;
      if (this.id) GL.framebuffers[this.id] = this.framebuffer;
    }
    const floats = new Float32Array(pose.views.length * kFloatsOfEye);
    pose.views.forEach((view, k) => {
      const {position} = view.transform, part = this.layer.getViewport(view);
      floats.set([...view.projectionMatrix, ...view.transform.inverse.matrix, position.x, position.y, position.z,
                  part.x, part.y, part.width, part.height], k * kFloatsOfEye);
    });
    this.#withFloats(floats, (at) => this.player.call(
      'page_picture_in_room', ['number', 'number', 'number', 'number', 'number', 'number', 'number'],
      [...head, at, pose.views.length, this.id, passed_s]));
  }
  #withFloats(floats, work) {
    const {module} = this.player, at = module._malloc(floats.byteLength);
    try {
      new Float32Array(module.HEAPU8.buffer, at, floats.length).set(floats);
      const answer = work(at);
      floats.set(new Float32Array(module.HEAPU8.buffer, at, floats.length));
      return answer;
    } finally {
      module._free(at);
    }
  }

  // The left stick walks, the right one turns in steps and, pushed ahead, points where to stand. True: it walks.
  #takeControllers(frame) {
    let walk = [0, 0];
    for (const source of this.session.inputSources) {
      const pad = source.gamepad;
      if (!pad || source.hand) continue;
      const [x, y] = pad.axes.length > 3 ? pad.axes.slice(2, 4) : pad.axes;
      if (source.handedness === 'right') this.#takeRight(source, x, y);
      else walk = [x ?? 0, -(y ?? 0)];
      for (const [k, action] of [[4, 'menu'], [5, 'menu'], [1, 'pause'], [3, 'ask']]) this.#takeButton(source, k, pad.buttons[k], action);
    }
    if (this.state?.page) walk = [0, 0];
    this.player.do('page_sticks', ['number', 'number', 'number', 'number'], [...walk, 0, 0]);
    if (this.aims) this.aims.there = this.#land(frame, this.aims.source, false);
    if (this.aims?.goes) {
      this.#land(frame, this.aims.source, true);
      this.aims = null;
    }
    return Math.hypot(...walk) > 0.2;
  }
  #takeRight(source, x = 0, y = 0) {
    if (Math.abs(x) > kPushed && this.snaps) this.player.do('page_turn_in_room', ['number'], [-Math.sign(x) * kSnap_rad]);
    this.snaps = Math.abs(x) < kLetGo || (this.snaps && Math.abs(x) <= kPushed);
    if (y < -kPushed && !this.aims && !this.state?.page) this.aims = {source, by: 'stick'};
    if (this.aims?.by === 'stick' && y > -kLetGo) this.aims.goes = true;
  }
  #takeButton(source, k, button, action) {
    const key = source.handedness + k, down = button?.pressed ?? false;
    if (down && !this.pressed.get(key)) {
      if (action === 'menu' && this.state?.page) this.player.do('page_back');
      else this.player.do('page_ask', ['string'], [action]);
    }
    this.pressed.set(key, down);
  }
  // Trigger or pinch: presses what the ray meets on a page, else points where to stand.
  #select(source, begins) {
    if (!begins) {
      if (this.aims?.source === source) this.aims.goes = true;
      return;
    }
    if (!this.state?.page) {
      this.aims = {source, by: 'trigger'};
      return;
    }
    const press = this.room.pressAt(this.lastRays?.find((ray) => ray.source === source));
    if (press === 'back') this.player.do('page_back');
    else if (press) this.player.do('page_press', ['string', 'number', 'number'], [this.state.page.name, press.row, press.which]);
  }
  #rayOf(frame, source) {
    const pose = source.targetRaySpace && frame.getPose(source.targetRaySpace, this.space);
    if (!pose) return null;
    const {x, y, z} = pose.transform.position, m = pose.transform.matrix;
    return {source, from: [x, y, z], along: [-m[8], -m[9], -m[10]]};
  }
  #rays(frame) {
    this.lastRays = [...this.session.inputSources].map((source) => this.#rayOf(frame, source)).filter((ray) => ray);
    return this.lastRays;
  }
  #land(frame, source, goes) {
    const ray = this.#rayOf(frame, source);
    if (!ray) return null;
    const floats = new Float32Array([...ray.from, ...ray.along]);
    const lands = this.#withFloats(floats, (at) => this.player.ask('page_land', ['number', 'number'], [at, goes ? 1 : 0]));
    return lands ? [...floats.slice(0, 3)] : null;
  }
}
