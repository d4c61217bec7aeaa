// The visitor's buttons over the picture, in the visitor's language: elements of the page, so that every hand, keyboard and screen
// reader finds them.
const kSigns = {  // paths in a square of 24
  tour: 'M6 3h2v18H6zM8 4h11l-3 4 3 4H8z',
  walk: 'M12 2a2 2 0 1 0 .01 0zM10 8l4-1 2 4 3 1-.6 1.8-3.6-1.2-1-1.8-.8 4 3 3v5h-2v-4l-3.5-3L9 22.5l-2-.5 2.5-11.5L8 12v3H6v-4z',
  pause: 'M6 5h4v14H6zM14 5h4v14h-4z',
  goOn: 'M8 5v14l11-7z',
  back: 'M5 5h3v14H5zM20 5v14L9 12z',
  next: 'M16 5h3v14h-3zM4 5v14l11-7z',
  fullscreen: 'M4 4h6v2H6v4H4zM14 4h6v6h-2V6h-4zM4 14h2v4h4v2H4zM18 14h2v6h-6v-2h4z'};

function element(kind, parent, attributes = {}) {
  return parent.appendChild(Object.assign(document.createElement(kind), attributes));
}

// A sign, and beside it its words where they are asked for and there is room; else they are read aloud.
function label(button, sign, words, beside = false) {
  if (button.title === words) return;
  button.title = words;
  button.setAttribute('aria-label', words);
  button.innerHTML = `<svg viewBox="0 0 24 24"><path d="${sign}"/></svg>`;
  if (beside) element('span', button, {textContent: words, className: 'words'});
}

export class Bar {
  // `described` as of page_description, `commands` as of the page, `words` by a language's code as of page_words.
  constructor(page, described, commands, words, language, signal) {
    Object.assign(this, {described, commands, wordsIn: words, language: null, state: null});
    this.halts = described.stops.map((stop, k) => ({...stop, k})).filter((stop) => stop.halt);
    this.bar = page.querySelector('#bar');
    this.bar.replaceChildren();
    const button = (press) => {
      const made = element('button', this.bar, {type: 'button'});
      made.addEventListener('click', press, {signal});
      return made;
    };
    if (this.halts.length > 0) {
      this.tour = button(() => commands.takeTour(!page.flaneur.state().follows_tour));
      this.pause = button(() => commands.pause(!page.flaneur.state().paused));
      this.back = button(() => this.goBy(-1));
      this.next = button(() => this.goBy(1));
      this.stops = element('select', this.bar);
      this.stops.addEventListener('change', () => commands.goToStop(+this.stops.value + 1), {signal});
      for (const stop of this.halts) element('option', this.stops, {value: stop.k});
    }
    if (described.languages.length > 1) {
      this.languages = element('select', this.bar);
      for (const code of described.languages) element('option', this.languages, {value: code, lang: code});
      this.languages.addEventListener('change', () => commands.setLanguage(this.languages.value), {signal});
    }
    if (document.fullscreenEnabled) {
      this.fullscreen = button(() => (document.fullscreenElement ? document.exitFullscreen() : page.requestFullscreen()));
    }
    this.over = page.querySelector('#over') ?? element('dialog', page, {id: 'over'});
    signal.addEventListener('abort', () => this.over.close());
    this.speak(language);
    this.bar.hidden = false;
  }
  goBy(many) {
    const at = this.halts.findLastIndex((stop) => stop.k <= (this.state?.stop ?? 0));
    const to = Math.min(Math.max(at + many, 0), this.halts.length - 1);
    this.commands.goToStop(this.halts[to].k + 1);
  }
  speak(language) {
    this.language = language;
    this.words = this.wordsIn(language);
    const {phrases, actions} = this.words;
    this.bar.lang = this.over.lang = language;
    this.bar.setAttribute('aria-label', phrases.tour);
    if (this.stops) {
      label(this.back, kSigns.back, actions.back);
      label(this.next, kSigns.next, actions.next);
      this.stops.setAttribute('aria-label', phrases.stops);
      const names = this.commands.stops();
      for (const option of this.stops.options) option.textContent = `${option.index + 1} ${names[option.value]?.name ?? ''}`;
    }
    if (this.languages) {
      this.languages.setAttribute('aria-label', phrases.language);
      for (const option of this.languages.options) option.textContent = this.words.languages[option.value];
    }
    if (this.fullscreen) label(this.fullscreen, kSigns.fullscreen, actions.fullscreen);
  }
  // What the last picture showed.
  show(state) {
    const ended = state.over && !this.state?.over, left = this.state?.over && !state.over;
    this.state = state;
    if (state.language && state.language !== this.language) this.speak(state.language);
    const {phrases} = this.words;
    if (this.tour) {
      label(this.tour, state.follows_tour ? kSigns.walk : kSigns.tour, state.follows_tour ? phrases.free_walk : phrases.tour,
            true);
      label(this.pause, state.paused ? kSigns.goOn : kSigns.pause, state.paused ? phrases.let_tour_go_on : phrases.hold_tour);
      this.pause.disabled = !state.follows_tour;
      const value = String(this.halts.findLast((stop) => stop.k <= state.stop)?.k ?? '');
      if (document.activeElement !== this.stops && this.stops.value !== value) this.stops.value = value;
    }
    if (this.languages && this.languages.value !== state.language) this.languages.value = state.language;
    if (ended) this.thank();
    if (left) this.over.close();
  }
  thank() {
    this.over.replaceChildren();
    element('p', this.over, {textContent: this.words.thanks});
    const choice = (words, press) => {
      element('button', this.over, {type: 'button', textContent: words}).addEventListener('click', () => {
        this.over.close();
        press();
      });
    };
    choice(this.words.phrases.again, () => this.commands.goToStop(1));
    choice(this.words.phrases.free_walk, () => this.commands.takeTour(false));
    this.over.showModal();
  }
}
