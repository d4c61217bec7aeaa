// What can go wrong, by its kind: a sentence of sentences.js.
export class Trouble extends Error {
  constructor(kind, detail = '') {
    super(detail);
    this.kind = kind;
  }
}

export const pause = (ms) => new Promise((done) => setTimeout(done, ms));
export const nextPicture = () => new Promise((done) => requestAnimationFrame(done));

export function element(kind, parent, attributes = {}) {
  return parent.appendChild(Object.assign(document.createElement(kind), attributes));
}
