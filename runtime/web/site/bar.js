// The visitor's buttons over the picture, in the visitor's language: elements of the page, so that every hand, keyboard and screen
// reader finds them.
import {element} from './trouble.js';

const kSigns = {  // paths in a square of 24
  tour: 'M6 3h2v18H6zM8 4h11l-3 4 3 4H8z',
  walk: 'M12 2a2 2 0 1 0 .01 0zM10 8l4-1 2 4 3 1-.6 1.8-3.6-1.2-1-1.8-.8 4 3 3v5h-2v-4l-3.5-3L9 22.5l-2-.5 2.5-11.5L8 12v3H6v-4z',
  pause: 'M6 5h4v14H6zM14 5h4v14h-4z',
  goOn: 'M8 5v14l11-7z',
  back: 'M5 5h3v14H5zM20 5v14L9 12z',
  next: 'M16 5h3v14h-3zM4 5v14l11-7z',
  map: 'M9 4l6 2 6-2v14l-6 2-6-2-6 2V6zM9 6v11l6 2V8z',
  photo: 'M8 6l2-2h4l2 2h4v13H4V6zM12 9a3.6 3.6 0 1 0 .01 0z',
  menu: 'M4 6h16v2H4zM4 11h16v2H4zM4 16h16v2H4z',
  fullscreen: 'M4 4h6v2H6v4H4zM14 4h6v6h-2V6h-4zM4 14h2v4h4v2H4zM18 14h2v6h-6v-2h4z',
  headset: 'M3 7h18v10h-6l-2-3h-2l-2 3H3zM7 10a1.8 1.8 0 1 0 .01 0zM17 10a1.8 1.8 0 1 0 .01 0z'};

// A sign, and beside it its words where they are asked for and there is room; else they are read aloud.
function label(button, sign, words, beside = false) {
  if (button.title === words) return;
  button.title = words;
  button.setAttribute('aria-label', words);
  button.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${sign}" fill-rule="evenodd"/></svg>`;
  if (beside) element('span', button, {textContent: words, className: 'words'});
}

export class Bar {
  // `described` as of page_description, `wordsIn` as of page_words by a language's code.
  constructor(page, described, player, wordsIn, signal) {
    Object.assign(this, {player, wordsIn, signal, language: null});
    this.bar = page.querySelector('#bar');
    this.bar.replaceChildren();
    const ask = (action) => this.button(() => player.do('page_ask', ['string'], [action]));
    if (described.stops.some((stop) => stop.halt)) {
      this.tour = ask('tour');
      this.pause = ask('pause');
      this.back = ask('back');
      this.next = ask('next');
    }
    this.map = ask('map');
    this.photo = ask('photo');
    this.menu = ask('menu');
    if (document.fullscreenEnabled)
      this.fullscreen = this.button(() => (document.fullscreenElement ? document.exitFullscreen() : page.requestFullscreen()));
    this.bar.hidden = false;
  }
  button(press) {
    const made = element('button', this.bar, {type: 'button'});
    made.addEventListener('click', press, {signal: this.signal});
    return made;
  }
  addHeadset(words, press) {
    label(this.button(press), kSigns.headset, words);
  }
  #speak(language) {
    this.language = language;
    const {phrases, actions} = this.words = this.wordsIn(language);
    this.bar.lang = language;
    this.bar.setAttribute('aria-label', phrases.tour);
    if (this.tour) {
      label(this.back, kSigns.back, actions.back);
      label(this.next, kSigns.next, actions.next);
    }
    label(this.map, kSigns.map, phrases.map);
    label(this.photo, kSigns.photo, phrases.photo);
    label(this.menu, kSigns.menu, actions.menu);
    if (this.fullscreen) label(this.fullscreen, kSigns.fullscreen, actions.fullscreen);
  }
  // What the last picture showed.
  show(state) {
    if (state.language !== this.language) this.#speak(state.language);
    if (!this.tour) return;
    const {phrases} = this.words, led = state.follows_tour;
    label(this.tour, led ? kSigns.walk : kSigns.tour, led ? phrases.free_walk : phrases.tour, true);
    const waits = state.paused || !led;
    label(this.pause, waits ? kSigns.goOn : kSigns.pause, waits ? phrases.let_tour_go_on : phrases.hold_tour);
  }
}
