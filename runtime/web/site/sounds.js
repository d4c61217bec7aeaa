// Spoken stops and the town's own sounds, from the visitor's first touch on: before it browsers play nothing.
import {pause} from './trouble.js';

const kRate_hz = 24000;   // of what the player computes
const kPart_ms = 20, kMostParts = 100;
const kFollows_s = 0.12;  // changes are as slow as they are told of

export class Sounds {
  constructor(player, signal) {
    Object.assign(this, {player, signal, spoken: 0, speech: null, round: new Map(), buffers: new Map(), computes: false, opening: null});
    const wake = () => {
      this.opening ??= this.#open();
      if (!document.hidden && this.context?.state === 'suspended') this.context.resume().catch(() => {});
    };
    for (const type of ['pointerdown', 'keydown', 'touchend']) addEventListener(type, wake, {signal, capture: true});
    if (navigator.userActivation?.hasBeenActive) wake();  // who has begun the tour by a button
  }
  // Some times a second.
  follow() {
    if (!this.context || this.context.state === 'closed') return;
    const told = this.player.read('page_sounds');
    this.#glide(this.voice.gain, told.volume);
    this.#glide(this.town.gain, told.volume);
    this.#speak(told);
    if (this.context.state !== 'running') return;
    this.#goRound(told.round);
    for (const sound of told.once) this.#play(sound);
  }

  // Browsers find out about the machine's sound when they are asked for its devices, and else hold the page up for it.
  async #open() {
    const {signal} = this;
    await navigator.mediaDevices?.enumerateDevices().catch(() => {});
    if (signal.aborted) return;
    this.context = new AudioContext();
    this.voice = this.#gain();
    this.town = this.#gain();
    document.addEventListener('visibilitychange', () => {
      if (this.context.state === 'closed') return;
      (document.hidden ? this.context.suspend() : this.context.resume()).catch(() => {});
    }, {signal});
    signal.addEventListener('abort', () => this.context.close().catch(() => {}));
  }
  #gain() {
    const gain = new GainNode(this.context);
    gain.connect(this.context.destination);
    return gain;
  }
  #glide(parameter, to) {
    parameter.setTargetAtTime(to, this.context.currentTime, kFollows_s);
  }
  async #speak(told) {
    if (this.speech) this.speech.playbackRate.value = told.paused ? 0 : 1;
    if (told.spoken === this.spoken) return;
    this.spoken = told.spoken;
    this.speech?.stop();
    this.speech = null;
    if (told.spoken === 0) return;
    const file = this.player.bytes('page_spoken').buffer;
    const buffer = await this.context.decodeAudioData(file).catch(() => null);
    if (!buffer || this.spoken !== told.spoken || this.context.state === 'closed') return;
    this.speech = new AudioBufferSourceNode(this.context, {buffer});
    this.speech.connect(this.voice);
    this.speech.start();
  }
  // Null while its file is on its way, or while it or another one is computed.
  async #bufferOf(recording) {
    const known = this.buffers.get(recording);
    if (known) return known;
    if (this.player.ask('page_is_computed', ['number'], [recording])) return this.#compute(recording);
    const bytes = this.player.bytes('page_recording', ['number'], [recording]);
    if (bytes.length === 0) return null;
    const decoded = this.context.decodeAudioData(bytes.buffer).catch(() => null);
    this.buffers.set(recording, decoded);
    return await decoded;
  }
  // A part at a time, between pictures.
  async #compute(recording) {
    if (this.computes) return null;
    this.computes = true;
    for (let part = 0; part < kMostParts; ++part) {
      await pause(kPart_ms);
      if (this.signal.aborted) return null;
      const bytes = this.player.bytes('page_recording', ['number'], [recording]);
      if (bytes.length === 0) continue;
      const whole = new Int16Array(bytes.buffer), samples = new Float32Array(whole.length);
      for (let k = 0; k < whole.length; ++k) samples[k] = whole[k] / 32768;
      const buffer = new AudioBuffer({length: samples.length, sampleRate: kRate_hz});
      buffer.copyToChannel(samples, 0);
      this.buffers.set(recording, buffer);
      break;
    }
    this.computes = false;
    return this.buffers.get(recording) ?? null;
  }
  // From its side; how loud it is there has been computed already.
  async #start(sound, loop) {
    const buffer = await this.#bufferOf(sound.recording);
    if (!buffer || this.context.state !== 'running') return null;
    const source = new AudioBufferSourceNode(this.context, {buffer, loop, playbackRate: sound.pitch});
    const gain = new GainNode(this.context, {gain: loop ? 0 : sound.gain});
    const panner = new PannerNode(this.context, {panningModel: 'equalpower', rolloffFactor: 0});
    source.connect(gain).connect(panner).connect(this.town);
    const node = {source, gain, panner};
    this.#put(node, sound);
    source.start();
    return node;
  }
  #put({panner}, {place: [x, y, z]}) {
    [panner.positionX.value, panner.positionY.value, panner.positionZ.value] = [x, y, z];
  }
  async #play(sound) {
    await this.#start(sound, false);
  }
  #goRound(sounds) {
    const heard = new Set(sounds.map((sound) => sound.source));
    for (const [source, node] of this.round) {
      if (heard.has(source) || !node.source) continue;
      this.#glide(node.gain.gain, 0);
      node.source.stop(this.context.currentTime + 5 * kFollows_s);
      this.round.delete(source);
    }
    for (const sound of sounds) this.#goOn(sound);
  }
  async #goOn(sound) {
    let node = this.round.get(sound.source);
    if (!node) {
      this.round.set(sound.source, {});  // on its way
      node = await this.#start(sound, true);
      if (!node) return void this.round.delete(sound.source);
      this.round.set(sound.source, node);
    }
    if (!node.source) return;
    this.#put(node, sound);
    this.#glide(node.gain.gain, sound.gain);
  }
}
