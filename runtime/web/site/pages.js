// The visitor's pages as elements: what stands on them the player tells, row by row, as it does to its own window.
import {directionOf, wrap} from './lines.js';
import {element} from './trouble.js';
import {say} from './sentences.js';

const kMostMap_px = 1024;

export class Pages {
  constructor(page, player, wordsIn, signal) {
    Object.assign(this, {player, wordsIn, signal, state: null, told: 'null', times: 1, photo: null});
    page.querySelector('#pages')?.remove();
    this.dialog = element('dialog', page, {id: 'pages'});
    this.dialog.setAttribute('dir', 'auto');
    const on = (type, take) => this.dialog.addEventListener(type, take, {signal});
    on('cancel', (e) => {
      e.preventDefault();
      this.#do('page_back');
    });
    on('keydown', (e) => this.#takeArrows(e));
    signal.addEventListener('abort', () => this.dialog.remove());
  }
  waitsForKey() {
    return this.state?.page?.waits_for_key ?? false;
  }
  // What the last picture showed. Built anew only where something has changed; the keyboard stays where it was.
  show(state) {
    const told = JSON.stringify([state.page, state.language, state.page && this.photo?.url]);
    this.state = state;
    if (told === this.told) return;
    const before = JSON.parse(this.told)?.[0]?.name, focused = [...this.#buttons()].indexOf(document.activeElement);
    this.told = told;
    if (!state.page) return this.#close();
    this.dialog.lang = state.language;
    this.dialog.className = 'of-' + state.page.name;
    this.dialog.replaceChildren();
    const head = element('h2', this.dialog, {textContent: state.page.head, id: 'pages-head'});
    this.dialog.setAttribute('aria-labelledby', head.id);
    if (state.page.name === 'map') this.#showMap();
    else if (state.page.name === 'photo') this.#showPhoto();
    else state.page.rows.forEach((row, k) => this.#showRow(row, k));
    if (state.page.back) this.#button(this.dialog, state.page.back, () => this.#do('page_back')).classList.add('back');
    if (!this.dialog.open) this.dialog.showModal();
    const buttons = this.#buttons();
    (before === state.page.name && buttons[focused] ? buttons[focused] : buttons[0])?.focus();
  }
  // A gamepad's button, where a page is open. False: it was not meant for it.
  takePad(name) {
    if (!this.dialog.open || this.waitsForKey()) return false;
    if (name === 'up' || name === 'down') this.#go(name === 'up' ? -1 : 1);
    else if (name === 'a') document.activeElement?.click();
    else if (name === 'b') this.#do('page_back');
    return true;
  }
  // Of the picture that the canvas shows just now.
  takePhoto(canvas, line) {
    const letters_px = Math.max(12, Math.round(Math.min(canvas.width, canvas.height) / 30)), high_px = 1.4 * letters_px;
    const font = `${letters_px}px system-ui, sans-serif`;
    const whole = document.createElement('canvas'), ink = whole.getContext('2d');
    ink.font = font;
    const lines = line ? wrap(ink, line, canvas.width * 0.96) : [];
    whole.width = canvas.width;
    whole.height = canvas.height + (lines.length > 0 ? Math.round((lines.length + 0.5) * high_px) : 0);
    ink.fillStyle = '#fff';
    ink.fillRect(0, 0, whole.width, whole.height);
    ink.drawImage(canvas, 0, 0);
    Object.assign(ink, {fillStyle: '#1a1712', font, textBaseline: 'middle', textAlign: 'center', direction: directionOf(line)});
    lines.forEach((each, k) => ink.fillText(each, whole.width / 2, canvas.height + (k + 0.75) * high_px));
    whole.toBlob((blob) => {
      if (this.photo) URL.revokeObjectURL(this.photo.url);
      this.photo = blob && {blob, url: URL.createObjectURL(blob)};
      if (this.state?.page?.name === 'photo') this.show(this.state);
    }, 'image/jpeg', 0.9);
  }

  // Whatever is open.
  close() {
    while (this.player.read('page_state').page) this.player.do('page_back');
    this.show(this.player.read('page_state'));
  }

  #close() {
    const was = this.dialog.open;
    this.dialog.close();
    this.dialog.replaceChildren();
    if (was) document.getElementById('canvas')?.focus();
  }
  #do(name, types = [], values = []) {
    this.player.do(name, types, values);
    this.show(this.player.read('page_state'));
  }
  #press(row, which) {
    this.#do('page_press', ['string', 'number', 'number'], [this.state.page.name, row, which]);
  }
  #buttons() {
    return this.dialog.querySelectorAll('button:not([tabindex="-1"]), a');
  }
  #go(by) {
    const all = [...this.#buttons()], at = all.indexOf(document.activeElement);
    all[(at + by + all.length) % all.length]?.focus();
  }
  #takeArrows(e) {
    const by = {ArrowDown: 1, ArrowUp: -1}[e.key];
    if (!by || this.waitsForKey()) return;
    this.#go(by);
    e.preventDefault();
  }
  #button(parent, text, press, says = '') {
    const made = element('button', parent, {type: 'button', textContent: text});
    if (says) made.setAttribute('aria-label', says);
    made.addEventListener('click', press, {signal: this.signal});
    return made;
  }
  #group(text) {
    const group = element('div', this.dialog, {className: 'row'});
    group.setAttribute('role', 'group');
    group.setAttribute('aria-label', text);
    element('span', group, {textContent: text});
    return group;
  }
  #showRow(row, k) {
    if (row.kind === 'words') return element('p', this.dialog, {textContent: row.text});
    if (row.kind === 'button') return this.#button(this.dialog, row.text, () => this.#press(k, 0));
    const group = this.#group(row.text);
    if (row.kind === 'choice')
      return row.buttons.forEach((text, b) => this.#button(group, text, () => this.#press(k, b), `${row.text}: ${text}`));
    this.#button(group, '−', () => this.#press(k, -1), `${row.text} −`);
    element('output', group, {textContent: row.value});
    this.#button(group, '+', () => this.#press(k, 1), `${row.text} +`);
  }

  // Where the map is touched, and where a stop is named, the visitor is led.
  #showMap() {
    const {phrases} = this.wordsIn(this.state.language), language = this.state.language;
    const here = element('p', this.dialog);
    const sheet = element('div', this.dialog, {className: 'map'}), canvas = element('canvas', sheet);
    const box = this.dialog.parentElement.getBoundingClientRect();
    const side = Math.min(kMostMap_px, Math.max(240, Math.min(box.width * 0.9, box.height * 0.6)));
    [canvas.width, canvas.height] = [Math.round(side), Math.round(side * 0.75)];
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', phrases.map);
    const marks = element('div', sheet, {className: 'marks'});
    const draw = () => {
      const at = this.player.ask('page_map', ['number', 'number', 'number'], [canvas.width, canvas.height, this.times]);
      const pixels = new Uint8ClampedArray(this.player.module.HEAPU8.slice(at, at + canvas.width * canvas.height * 4).buffer);
      canvas.getContext('2d').putImageData(new ImageData(pixels, canvas.width, canvas.height), 0, 0);
      const told = this.player.read('page_map_marks');
      here.textContent = `${told.here.text}. ${phrases.map_tap}`;
      this.#showMarks(told, canvas, marks);
      return told;
    };
    canvas.addEventListener('click', (e) => {
      const at = canvas.getBoundingClientRect();
      this.#do('page_lead_to_place', ['number', 'number'],
               [(e.clientX - at.left) / at.width * canvas.width, (e.clientY - at.top) / at.height * canvas.height]);
    }, {signal: this.signal});
    const told = draw();
    const zoom = this.#group(phrases.zoom);
    const times = (factor) => () => {
      this.times = Math.min(16, Math.max(1, this.times * factor));
      draw();
    };
    this.#button(zoom, '−', times(0.5), `${phrases.zoom} −`);
    this.#button(zoom, '+', times(2), `${phrases.zoom} +`);
    const list = element('ol', this.dialog, {lang: language});
    for (const stop of told.stops) this.#button(element('li', list), stop.name, this.#leadTo(stop.stop));
  }
  #leadTo(stop) {
    return () => this.#do('page_lead_to_stop', ['number'], [stop]);
  }
  #showMarks(told, canvas, marks) {
    marks.replaceChildren();
    const put = (kind, place, attributes) => {
      const [x, y] = place;
      if (x < 0 || y < 0 || x > canvas.width || y > canvas.height) return null;
      const made = element(kind, marks, attributes);
      made.style.left = `${100 * x / canvas.width}%`;
      made.style.top = `${100 * y / canvas.height}%`;
      made.setAttribute('aria-hidden', 'true');  // the list below says the same
      return made;
    };
    if (this.times > 1) for (const street of told.streets) put('span', street.place, {textContent: street.name});
    for (const stop of told.stops) {
      const pin = put('button', stop.place, {type: 'button', textContent: stop.number, tabIndex: -1});
      pin?.addEventListener('click', this.#leadTo(stop.stop), {signal: this.signal});
    }
    const self = put('i', told.here.place, {});
    if (self) self.style.rotate = `${90 - told.here.yaw_rad * 180 / Math.PI}deg`;
  }

  #showPhoto() {
    const language = this.state.language;
    if (!this.photo) return;
    element('img', this.dialog, {src: this.photo.url, alt: this.state.page.head});
    const name = 'photo.jpg', file = new File([this.photo.blob], name, {type: 'image/jpeg'});
    element('a', this.dialog, {href: this.photo.url, download: name, textContent: say('save', language), className: 'button'});
    if (navigator.canShare?.({files: [file]}))
      this.#button(this.dialog, say('share', language), () => navigator.share({files: [file]}).catch(() => {}));
  }
}
