// What stands in a headset's room besides the town: pages and captions as panels, the rays of the hands, where one would
// land, and the vignette of smooth walking. Drawn over the finished picture of each eye.
import {directionOf, wrap} from './lines.js';

const kPanel_px = 1024, kPanel_m = 1.3, kPanelAway_m = 1.5;
const kCaption_px = [1024, 256], kCaption_m = [1.5, 0.375], kCaptionAway_m = 1.9, kCaptionBelow_m = 0.55;
const kUnit = 15;             // of the textures' units, one that the player leaves alone
const kLeastInParts_px = 32;  // letters as small as that, before a caption is shown in parts
const kFollows_s = 0.4;       // the caption comes after the head
const kVignette = 0.85, kVignetteCalm = 1, kVignette_s = 0.25;

const kVertex = `#version 300 es
uniform mat4 m; out vec2 uv;
void main() { uv = vec2(gl_VertexID & 1, gl_VertexID >> 1); gl_Position = m * vec4(uv * 2.0 - 1.0, 0.0, 1.0); }`;
const kFragment = `#version 300 es
precision mediump float;
uniform sampler2D words; uniform int kind; uniform vec4 ink; in vec2 uv; out vec4 color;
void main() {
  vec2 off = uv * 2.0 - 1.0;
  float r = length(off);
  if (kind == 0) color = texture(words, vec2(uv.x, 1.0 - uv.y));
  else if (kind == 1) color = vec4(0.0, 0.0, 0.0, ink.a * smoothstep(0.45, 0.95, r));
  else if (kind == 2) color = vec4(ink.rgb, ink.a * smoothstep(1.0, 0.95, r) * smoothstep(0.6, 0.7, r));
  else color = ink;
}`;

// Column by column, as WebGL has them.
function times(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; ++c)
    for (let r = 0; r < 4; ++r)
      for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}
const add = (a, b, s = 1) => a.map((v, k) => v + s * b[k]);
const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const place = (x, y, z, at) => new Float32Array([...x, 0, ...y, 0, ...z, 0, ...at, 1]);

// Upright, its face to where `towards` comes from.
function panelAt(at, towards, wide, high) {
  const flat = length([towards[0], 0, towards[2]]) || 1, z = [-towards[0] / flat, 0, -towards[2] / flat], x = [z[2], 0, -z[0]];
  return {at, x, z, wide, high, matrix: place(x.map((v) => v * wide / 2), [0, high / 2, 0], z, at)};
}

// Of as many parts the one that is due while a caption is read; passed: of the time, below 0 where it isn't known.
const partDue = (passed, count) => Math.min(count - 1, Math.max(0, Math.floor(passed * count)));

export class Room {
  constructor(gl) {
    Object.assign(this, {gl, panel: null, told: '', fields: [], caption: '', parts: {due: 0, count: 1}, captionPanel: null, hovered: null, dark: 0});
    const shader = (type, text) => {
      const made = gl.createShader(type);
      gl.shaderSource(made, text);
      gl.compileShader(made);
      return made;
    };
    this.program = gl.createProgram();
    gl.attachShader(this.program, shader(gl.VERTEX_SHADER, kVertex));
    gl.attachShader(this.program, shader(gl.FRAGMENT_SHADER, kFragment));
    gl.linkProgram(this.program);
    this.at = Object.fromEntries(['m', 'words', 'kind', 'ink'].map((name) => [name, gl.getUniformLocation(this.program, name)]));
    this.array = gl.createVertexArray();
    this.page = this.#sheet(kPanel_px, kPanel_px);
    this.words = this.#sheet(...kCaption_px);
  }
  #sheet(width, height) {
    const {gl} = this, canvas = Object.assign(document.createElement('canvas'), {width, height}), texture = gl.createTexture();
    return {canvas, ink: canvas.getContext('2d'), texture, fresh: false};
  }
  // Some times a second: what the player shows.
  show(state, pose) {
    const told = JSON.stringify([state.page, state.text_size, state.high_contrast, this.hovered]);
    if (!state.page) this.panel = null;
    else if (!this.panel) this.panel = this.#ahead(pose, kPanelAway_m, 0.1, kPanel_m, kPanel_m);
    if (state.page && told !== this.told) this.#write(state);
    this.told = told;
    const caption = state.page ? '' : state.caption;
    if (caption !== this.caption || partDue(state.caption_passed, this.parts.count) !== this.parts.due) this.#writeCaption(caption, state);
    this.caption = caption;
  }
  // Row and button under a ray; null: none.
  pressAt(ray) {
    const hit = this.#hit(ray);
    return hit ? this.#fieldAt(hit)?.press ?? null : null;
  }
  draw(layer, pose, {walks, passed_s, rays, landing, calm}) {
    const {gl} = this;
    const wanted = walks ? (calm ? kVignetteCalm : kVignette) : 0;
    this.dark += (wanted - this.dark) * Math.min(1, passed_s / kVignette_s);
    if (this.caption) this.#followHead(pose, passed_s);
    this.hovered = this.panel ? rays.map((ray) => this.#hit(ray)).map((hit) => hit && this.#fieldAt(hit)?.key).find((key) => key) ?? null : null;
    gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
    gl.useProgram(this.program);
    gl.bindVertexArray(this.array);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniform1i(this.at.words, kUnit);
    for (const view of pose.views) {
      const part = layer.getViewport(view);
      gl.viewport(part.x, part.y, part.width, part.height);
      this.#drawIn(times(view.projectionMatrix, view.transform.inverse.matrix), view, rays, landing);
    }
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
    gl.activeTexture(gl.TEXTURE0);
  }

  #drawIn(matrix, view, rays, landing) {
    const put = (model, kind, ink = [1, 1, 1, 1]) => this.#quad(times(matrix, model), kind, ink);
    if (landing) put(place([0.35, 0, 0], [0, 0, -0.35], [0, 1, 0], add(landing, [0, 0.03, 0])), 2, [1, 0.84, 0.37, 0.95]);
    if (this.dark > 0.02) this.#quad(new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), 1, [0, 0, 0, this.dark]);
    if (this.caption && this.captionPanel) this.#sheetAt(this.words, put, this.captionPanel.matrix);
    if (this.panel) this.#sheetAt(this.page, put, this.panel.matrix);
    const eye = view.transform.position;
    for (const ray of rays) put(this.#beam(ray, [eye.x, eye.y, eye.z], landing), 3, [1, 1, 1, 0.6]);
  }
  #sheetAt(sheet, put, matrix) {
    const {gl} = this;
    gl.activeTexture(gl.TEXTURE0 + kUnit);
    gl.bindTexture(gl.TEXTURE_2D, sheet.texture);
    if (!sheet.fresh) {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, sheet.canvas);
      gl.generateMipmap(gl.TEXTURE_2D);
      sheet.fresh = true;
    }
    put(matrix, 0);
  }
  #quad(matrix, kind, ink) {
    const {gl} = this;
    gl.uniformMatrix4fv(this.at.m, false, matrix);
    gl.uniform1i(this.at.kind, kind);
    gl.uniform4fv(this.at.ink, ink);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }
  // A thin band that turns its breadth to the eye.
  #beam(ray, eye, landing) {
    const hit = this.#hit(ray), reach = hit ? hit.far : landing ? length(add(landing, ray.from, -1)) : 1.2;
    const half = ray.along.map((v) => v * reach / 2), at = add(ray.from, half), side = cross(half, add(eye, at, -1));
    const broad = 0.003 / (length(side) || 1);
    return place(side.map((v) => v * broad), half, [0, 0, 1], at);
  }
  #ahead(pose, away, below, wide, high) {
    const {x, y, z} = pose.transform.position, m = pose.transform.matrix, flat = Math.hypot(m[8], m[10]) || 1;
    const towards = [-m[8] / flat, 0, -m[10] / flat];
    return panelAt([x + towards[0] * away, y - below, z + towards[2] * away], towards, wide, high);
  }
  #followHead(pose, passed_s) {
    const wanted = this.#ahead(pose, kCaptionAway_m, kCaptionBelow_m, ...kCaption_m), now = this.captionPanel;
    if (!now) return void (this.captionPanel = wanted);
    const share = Math.min(1, passed_s / kFollows_s), {x, y, z} = pose.transform.position;
    const at = now.at.map((v, k) => v + (wanted.at[k] - v) * share);
    this.captionPanel = panelAt(at, add(at, [x, y, z], -1), ...kCaption_m);
  }
  #hit(ray) {
    if (!ray || !this.panel) return null;
    const {at, x, z, wide, high} = this.panel, towards = dot(ray.along, z);
    if (towards > -1e-4) return null;
    const far = dot(add(at, ray.from, -1), z) / towards, point = add(add(ray.from, ray.along, far), at, -1);
    const u = dot(point, x) / wide + 0.5, v = 0.5 - point[1] / high;
    return far > 0 && u >= 0 && u <= 1 && v >= 0 && v <= 1 ? {far, x: u * kPanel_px, y: v * kPanel_px} : null;
  }
  #fieldAt({x, y}) {
    return this.fields.find((f) => x >= f.x && x < f.x + f.wide && y >= f.y && y < f.y + f.high);
  }

  // Rows as the player tells them; what does not fit gets smaller.
  #write(state) {
    const {ink} = this.page, {page} = state, rows = page.rows ?? [];
    const count = rows.length + (page.back ? 1 : 0), head = 150, gap = 8;
    const high = Math.min(84, (kPanel_px - head - 20) / Math.max(1, count) - gap), letters = Math.min(44, high * 0.55);
    ink.clearRect(0, 0, kPanel_px, kPanel_px);
    ink.fillStyle = state.high_contrast ? '#000' : 'rgba(18, 15, 13, 0.92)';
    ink.fillRect(0, 0, kPanel_px, kPanel_px);
    ink.textBaseline = 'middle';
    ink.fillStyle = '#fff';
    ink.font = '600 46px system-ui, sans-serif';
    ink.textAlign = 'left';
    ink.direction = directionOf(page.head);
    wrap(ink, page.head, kPanel_px - 80).slice(0, 2).forEach((line, k) => ink.fillText(line, 40, 50 + 54 * k));
    this.fields = [];
    let y = head;
    const button = (text, x, wide, press, key) => {
      this.fields.push({x, y, wide, high, press, key});
      ink.fillStyle = key === this.hovered ? '#a86b24' : state.high_contrast ? '#222' : '#3a3428';
      ink.fillRect(x, y, wide, high);
      ink.fillStyle = '#fff';
      ink.fillText(text, x + 16, y + high / 2, wide - 32);
    };
    ink.font = `${letters}px system-ui, sans-serif`;
    rows.forEach((row, k) => {
      const text = (wide) => ink.fillText(row.text, 40, y + high / 2, wide);
      ink.fillStyle = '#fff';
      if (row.kind === 'button') button(row.text, 24, kPanel_px - 48, {row: k, which: 0}, `${k}`);
      else if (row.kind === 'words') text(kPanel_px - 80);
      else if (row.kind === 'amount') {
        text(480);
        button('−', 560, 90, {row: k, which: -1}, `${k}-`);
        ink.fillText(row.value, 670, y + high / 2, 210);
        button('+', 910, 90, {row: k, which: 1}, `${k}+`);
      } else {
        text(380);
        const wide = 560 / row.buttons.length;
        row.buttons.forEach((name, b) => button(name, 440 + wide * b, wide - gap, {row: k, which: b}, `${k} ${b}`));
      }
      y += high + gap;
    });
    if (page.back) button(page.back, 24, kPanel_px - 48, 'back', 'back');
    this.page.fresh = false;
  }
  #writeCaption(text, state) {
    const {ink} = this.words, [width, height] = kCaption_px;
    const large = {large: 1.3, largest: 1.65}[state.text_size] ?? 1;
    ink.clearRect(0, 0, width, height);
    this.parts = {due: 0, count: 1};
    if (!text) return;
    let letters = 44 * large, lines = [];
    for (const least = state.caption_passed >= 0 ? kLeastInParts_px : 16; letters > least; letters *= 0.9) {
      ink.font = `${letters}px system-ui, sans-serif`;
      lines = wrap(ink, text, width - 60);
      if (lines.length * letters * 1.25 < height - 20) break;
    }
    const most = Math.max(1, Math.floor((height - 20) / (letters * 1.25))), each = Math.ceil(lines.length / Math.ceil(lines.length / most));
    const count = Math.ceil(lines.length / each);
    if (state.caption_passed >= 0) this.parts = {due: partDue(state.caption_passed, count), count};
    lines = lines.slice(this.parts.due * each, (this.parts.due + 1) * each);
    const high = lines.length * letters * 1.25 + 20;
    ink.fillStyle = state.high_contrast ? '#000' : 'rgba(0, 0, 0, 0.78)';
    ink.fillRect(0, height - high, width, high);
    ink.fillStyle = state.high_contrast ? '#ff0' : '#fff';
    ink.textAlign = 'center';
    ink.textBaseline = 'middle';
    ink.direction = directionOf(text);
    lines.forEach((line, k) => ink.fillText(line, width / 2, height - high + 10 + letters * 1.25 * (k + 0.5)));
    this.words.fresh = false;
  }
}
