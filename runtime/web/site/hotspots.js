// Things in the town that tell something: a mark on each that is seen, and a panel for the one that tells.
import {element} from './trouble.js';

export class HotspotMarks {
  constructor(page, player, wordsIn, signal) {
    Object.assign(this, {player, wordsIn, signal, marks: new Map(), told: -1, language: '', picture: null});
    for (const old of page.querySelectorAll('#marks, #told')) old.remove();
    this.field = element('div', page, {id: 'marks'});
    this.panel = element('section', page, {id: 'told', hidden: true});
    this.panel.setAttribute('aria-live', 'polite');
    signal.addEventListener('abort', () => this.clear());
  }
  clear() {
    this.field.replaceChildren();
    this.marks.clear();
    this.#forgetPicture();
    this.panel.hidden = true;
    this.told = -1;
  }
  // Once a picture. state: of a moment ago.
  follow(state) {
    if (state.page || (state.hotspots === 0 && state.told < 0)) {
      if (this.marks.size > 0 || this.told >= 0) this.clear();
      return;
    }
    const {marks, told} = this.player.read('page_hotspots');
    const seen = new Set(marks.map((mark) => mark.hotspot));
    for (const [hotspot, button] of this.marks) {
      if (seen.has(hotspot)) continue;
      button.remove();
      this.marks.delete(hotspot);
    }
    for (const mark of marks) this.#place(mark, mark.hotspot === told?.hotspot);
    this.#tell(told, state.language);
  }
  #tap(hotspot) {
    this.player.do('page_tap_hotspot', ['number'], [hotspot]);
  }
  #place(mark, tells) {
    let button = this.marks.get(mark.hotspot);
    if (!button) {
      button = element('button', this.field, {type: 'button'});
      button.addEventListener('click', () => this.#tap(mark.hotspot), {signal: this.signal});
      this.marks.set(mark.hotspot, button);
    }
    if (button.title !== mark.title) {
      button.title = mark.title;
      button.setAttribute('aria-label', mark.title);
    }
    button.setAttribute('aria-expanded', tells);
    button.style.left = `${100 * mark.place[0]}%`;
    button.style.top = `${100 * mark.place[1]}%`;
    button.style.setProperty('--interest', mark.interest.toFixed(2));
  }
  #forgetPicture() {
    if (this.picture) URL.revokeObjectURL(this.picture);
    this.picture = null;
  }
  #tell(told, language) {
    const now = told?.hotspot ?? -1;
    if (now === this.told && language === this.language) return;
    [this.told, this.language] = [now, language];
    this.#forgetPicture();
    this.panel.hidden = !told;
    if (!told) return;
    this.panel.lang = language;
    this.panel.replaceChildren();
    element('h2', this.panel, {textContent: told.title, dir: 'auto'});
    const close = element('button', this.panel, {type: 'button', textContent: '×'});
    close.setAttribute('aria-label', this.wordsIn(language).phrases.continue);
    close.addEventListener('click', () => this.#tap(told.hotspot), {signal: this.signal});
    const bytes = told.picture < 0 ? [] : this.player.bytes('page_pack_picture', ['number'], [told.picture]);
    if (bytes.length > 0) {
      this.picture = URL.createObjectURL(new Blob([bytes]));
      element('img', this.panel, {src: this.picture, alt: told.title});
    }
    element('p', this.panel, {textContent: told.text, dir: 'auto'});
  }
}
