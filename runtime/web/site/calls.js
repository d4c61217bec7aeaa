// The player's functions, as page.cpp has them.
import {fetchPacked} from './files.js';
import {Trouble} from './trouble.js';

const kindOf = (wrong) => (wrong.includes('WebGL') ? 'webgl' : wrong.includes('memory') ? 'memory' : 'fault');

export class Player {
  constructor(module) {
    this.module = module;
  }
  // Throws what the player says is wrong.
  call(name, types = [], values = []) {
    const wrong = this.module.ccall(name, 'string', types, values);
    if (wrong) throw new Trouble(kindOf(wrong), wrong);
  }
  do(name, types = [], values = []) {
    return this.module.ccall(name, null, types, values);
  }
  ask(name, types = [], values = []) {
    return this.module.ccall(name, 'number', types, values);
  }
  text(name, types = [], values = []) {
    return this.module.ccall(name, 'string', types, values);
  }
  read(name, types = [], values = []) {
    return JSON.parse(this.text(name, types, values));
  }
  // A copy.
  bytes(name, types = [], values = []) {
    return this.#withPlace(4, (count) => {
      const at = this.ask(name, [...types, 'number'], [...values, count]);
      const bytes = new DataView(this.module.HEAPU8.buffer).getInt32(count, true);
      return this.module.HEAPU8.slice(at, at + bytes);
    });
  }
  arrive(piece, content) {
    this.#withPlace(content.length, (place) => {
      this.module.HEAPU8.set(content, place);
      let at = place;
      for (const [offset, bytes] of piece.parts) {
        this.call('page_arrive', ['number', 'number', 'number'], [offset, at, bytes]);
        at += bytes;
      }
    });
  }
  isLoaded() { return this.#isSaid('page_load'); }
  isAllLoaded() { return this.#isSaid('page_load_more'); }
  #isSaid(name) {
    return this.#withPlace(1, (place) => {
      this.call(name, ['number'], [place]);
      return this.module.HEAPU8[place] !== 0;
    });
  }
  #withPlace(bytes, work) {
    const place = this.module._malloc(bytes);
    if (!place) throw new Trouble('memory');
    try {
      return work(place);
    } finally {
      this.module._free(place);
    }
  }
}

export async function makeModule(store, site, canvas) {
  const script = import('./' + site.script);
  script.catch(() => {});
  const binary = await fetchPacked(store, site.player);
  let make = null;
  try {
    ({default: make} = await script);
  } catch (e) {
    throw new Trouble(e instanceof SyntaxError ? 'corrupt' : 'cut', site.script);
  }
  try {
    return await make({canvas, wasmBinary: binary, printErr: (line) => console.error(line)});
  } catch (e) {
    const text = String(e?.message ?? e);
    throw new Trouble(e instanceof RangeError || /memory/.test(text) ? 'memory' : /CompileError|invalid|SIMD/.test(text) ? 'browser' : 'fault', text);
  }
}
