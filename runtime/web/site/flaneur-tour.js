// <flaneur-tour src="…" stop="3" lang="de">: a tour that `flaneur web` wrote, in any page. One script, no module: it asks for no headers
// of the tour's host. The tour is in a frame of its own, so that several stand on a page and none touches what is around it.
(() => {
  if (!globalThis.customElements || customElements.get('flaneur-tour')) return;

  const kSpeaks = 1;  // of the messages to and from the tour's page
  const kAnswers_ms = 15000;  // from a frame that has loaded until it must have said that it is a tour
  const kSentences = {
    en: 'There is no tour at this address.', de: 'Unter dieser Adresse ist kein Rundgang.',
    fr: 'Il n’y a pas de visite à cette adresse.', it: 'A questo indirizzo non c’è nessuna visita.',
    es: 'No hay ninguna visita en esta dirección.'};
  const kStyle = ':host{display:block;position:relative;aspect-ratio:16/9;min-height:12rem;background:#1a1712;color:#fff}' +
    ':host([hidden]){display:none}iframe{position:absolute;inset:0;width:100%;height:100%;border:0}' +
    'p{position:absolute;inset:0;margin:auto;padding:1em;height:max-content;text-align:center;font:1.1rem/1.4 system-ui,sans-serif}';
  const kAllow = 'fullscreen; gamepad; autoplay; xr-spatial-tracking';
  const all = new Set();  // in this page

  class FlaneurTour extends HTMLElement {
    static observedAttributes = ['src', 'stop', 'lang', 'title'];
    #frame = null;
    #origin = '';
    #state = 'empty';
    #description = null;
    #at = null;
    #wishes = new Map();  // until there is somebody to hear them
    #patience = 0;
    #heard = (e) => this.#hear(e);

    constructor() {
      super();
      const style = new CSSStyleSheet();
      style.replaceSync(kStyle);
      this.attachShadow({mode: 'open'}).adoptedStyleSheets = [style];
    }
    connectedCallback() {
      all.add(this);
      addEventListener('message', this.#heard);
      this.#show();
    }
    disconnectedCallback() {
      all.delete(this);
      removeEventListener('message', this.#heard);
      this.#forget();
    }
    attributeChangedCallback(name, before, now) {
      if (!this.isConnected || before === now) return;
      if (name === 'src') this.#show();
      else if (name === 'title' && this.#frame) this.#frame.title = this.title;
      else if (name === 'stop' && this.stop) this.goToStop(this.stop);
      else if (name === 'lang' && this.lang) this.setLanguage(this.lang);
    }

    get src() { return this.getAttribute('src') ?? ''; }
    set src(address) { this.setAttribute('src', address); }
    get stop() { return Math.max(0, Math.trunc(Number(this.getAttribute('stop')))) || 0; }
    set stop(stop) { this.setAttribute('stop', stop); }
    get state() { return this.#state; }
    get description() { return this.#description; }
    get currentStop() { return this.#at; }

    goToStop(stop) { this.#ask('goToStop', stop); }
    setLanguage(language) { this.#ask('setLanguage', language); }
    takeTour(follows = true) { this.#ask('takeTour', follows); }
    pause(pauses = true) { this.#ask('pause', pauses); }

    #show() {
      this.#forget();
      let address = null;
      try {
        if (this.src) address = new URL(this.src, document.baseURI);
      } catch {}
      if (!address) return this.src ? this.#fail() : undefined;
      const wishes = new URLSearchParams(address.hash.slice(1));
      if (this.stop) wishes.set('stop', this.stop);
      if (this.lang) wishes.set('lang', this.lang);
      address.hash = wishes;
      this.#origin = address.origin;
      this.#state = 'waiting';
      this.#frame = document.createElement('iframe');
      Object.assign(this.#frame, {allow: kAllow, loading: 'lazy', title: this.title || 'Tour', src: address.href});
      this.#frame.addEventListener('load', () => {
        clearTimeout(this.#patience);
        this.#patience = setTimeout(() => this.#fail(), kAnswers_ms);
      });
      this.shadowRoot.append(this.#frame);
    }
    #forget() {
      clearTimeout(this.#patience);
      this.shadowRoot.replaceChildren();
      this.#frame = this.#description = this.#at = null;
      this.#wishes.clear();
      this.#state = 'empty';
    }
    #fail(kind = 'missing') {
      this.#forget();
      this.#state = 'failed';
      const sentence = document.createElement('p');
      sentence.textContent = (kSentences[this.lang.slice(0, 2)] ?? kSentences.en) + ' (' + this.src + ')';
      sentence.setAttribute('role', 'alert');
      this.shadowRoot.append(sentence);
      this.#tell('failed', {kind, detail: this.src});
    }
    #tell(type, detail) { this.dispatchEvent(new CustomEvent(type, {detail, bubbles: true})); }
    #ask(what, value) {
      if (this.#state !== 'visiting') return void this.#wishes.set(what, value);
      this.#frame.contentWindow.postMessage({flaneur: what, value}, this.#origin);
    }
    #hear(e) {
      if (!this.#frame || e.source !== this.#frame.contentWindow || e.origin !== this.#origin || !e.data?.flaneur) return;
      const {flaneur: type, ...detail} = e.data;
      clearTimeout(this.#patience);
      if (type === 'ready') {
        if (detail.speaks !== kSpeaks) this.#fail('version');
        return;
      }
      if (type === 'begun') {
        this.#state = 'loading';
        for (const other of all) if (other !== this && other.state === 'visiting') other.pause();  // one speaks at a time
      }
      if (type === 'tour-loaded') this.#meet(detail);
      if (type === 'stop-reached') this.#at = detail.stop;
      if (type === 'failed') this.#state = 'failed';
      this.#tell(type, detail);
    }
    #meet(description) {
      this.#state = 'visiting';
      this.#description = description;
      if (!this.title) this.#frame.title = description.title || 'Tour';
      for (const [what, value] of this.#wishes) this.#ask(what, value);
      this.#wishes.clear();
    }
  }

  customElements.define('flaneur-tour', FlaneurTour);
})();
