// Text on a canvas, which knows neither lines nor the direction of a script.

// Of a word that is wider than a line, as sentences are in scripts without spaces: where it may be broken.
const pieces = (word) => Intl.Segmenter ? Array.from(new Intl.Segmenter(undefined, {granularity: 'word'}).segment(word), (s) => s.segment) : [...word];

// No wider than `most` in the ink's font, where it can be broken.
export function wrap(ink, text, most) {
  const fits = (line) => ink.measureText(line).width <= most;
  const lines = [];
  const add = (piece, gap) => {
    const longer = lines.length > 0 ? lines.at(-1) + gap + piece : piece;
    if (lines.length > 0 && fits(longer)) lines[lines.length - 1] = longer;
    else lines.push(piece);
  };
  for (const word of text.trim().split(/\s+/)) {
    if (fits(word)) add(word, ' ');
    else pieces(word).forEach((piece, k) => fits(piece) ? add(piece, k > 0 ? '' : ' ') : [...piece].forEach((letter) => add(letter, '')));
  }
  return lines;
}

// By the first letter, as HTML's dir="auto".
export function directionOf(text) {
  return /^[^\p{L}]*[\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc]/u.test(text) ? 'rtl' : 'ltr';
}
