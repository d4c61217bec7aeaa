// stills.mjs SITE DRAW_STILL.js FOLDER WIDTHxHEIGHT SCENARIO.toml ...: what flaneur-player --screenshot draws of each scenario, drawn by
// Debian's Chromium from the tour in SITE, which `flaneur web` wrote; FOLDER gets a PNG of each, named as its scenario.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import zlib from 'node:zlib';
import {launch, typeOf} from './chromium.mjs';

const [site, program, folder, size, ...scenarios] = process.argv.slice(2);
if (scenarios.length === 0 || !fs.existsSync(path.join(site, 'tour.json'))) {
  console.error('stills.mjs: error: name a folder that flaneur web wrote, the program, a folder for pictures, their size and scenarios');
  process.exit(2);
}

// The pack that the pieces of the site make up.
function packOf(site) {
  const {bytes, pieces} = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
  const pack = Buffer.alloc(bytes);
  for (const {file, parts} of pieces) {
    const piece = zlib.gunzipSync(fs.readFileSync(path.join(site, file)));
    let at = 0;
    for (const [offset, length] of parts) at += piece.copy(pack, offset, at, at + length);
  }
  return pack;
}

const kPage = `<!doctype html><canvas id="picture"></canvas><script src="/${path.basename(program)}"></script>`;
const answers = new Map([['/', [Buffer.from(kPage), 'page.html']], ['/pack', [packOf(site), 'tour.glb']]]);
for (const file of [program, program.replace(/\.js$/, '.wasm')])
  answers.set('/' + path.basename(file), [fs.readFileSync(file), file]);
const server = http.createServer((request, response) => {
  const answer = answers.get(request.url);
  if (!answer) return response.writeHead(404).end();
  response.writeHead(200, {'Content-Type': typeOf(answer[1])}).end(answer[0]);
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

const browser = await launch();
const [width_px, height_px] = size.split('x').map(Number);
for (const scenario of scenarios) {
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const {said, picture} = await page.evaluate(async (text, width_px, height_px) => {
    const player = await globalThis.makeDrawStill();
    player.FS.writeFile('pack.glb', new Uint8Array(await (await fetch('/pack')).arrayBuffer()));
    player.FS.writeFile('scenario.toml', text);
    const said = player.ccall('draw_still', 'string', ['number', 'number'], [width_px, height_px]);
    return {said, picture: said ? [] : Array.from(player.FS.readFile('still.png'))};
  }, fs.readFileSync(scenario, 'utf8'), width_px, height_px);
  if (said) {
    console.error(`stills.mjs: error: ${scenario}: ${said}`);
    process.exit(1);
  }
  fs.writeFileSync(path.join(folder, path.basename(scenario, '.toml') + '.png'), Buffer.from(picture));
  await page.close();
}
await browser.close();
process.exit();
