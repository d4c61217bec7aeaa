// three_bench.mjs SITE PACK PLAYER: the tour in a page against a three.js scene of the same pack, in Debian's Chromium without a
// graphics card: the same town, the same people at the same places, the same view and the same pixels. three.js draws every person's finest
// level by instanced skinning (npm @three.ez/instanced-mesh, which leaves out who is beside the picture); they stand posed and nothing
// steers, turns or shadows them, all of which the tour does. SITE is what `flaneur web PACK` wrote; PACK says how many people there are.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import {launch, typeOf} from './chromium.mjs';

const [site, pack, player] = process.argv.slice(2);
if (!player || !fs.existsSync(path.join(site, 'tour.json'))) {
  console.error('three_bench.mjs: error: name a folder that flaneur web wrote, its pack and flaneur-player');
  process.exit(2);
}
const kWidth_px = 1280, kHeight_px = 720, kSeconds = 20;
const modules = path.join(import.meta.dirname, 'node_modules');
if (!fs.existsSync(path.join(modules, '@three.ez/instanced-mesh'))) {
  console.error('three_bench.mjs: error: three.js is not installed here: npm ci --prefix ' + path.relative('.', import.meta.dirname));
  process.exit(2);
}

// Where everybody is in the first picture, and from where it is seen.
function placesOfAll() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'flaneur_three_'));
  const rows = (file) => {
    const [names, ...lines] = fs.readFileSync(path.join(folder, file), 'utf8').trim().split('\n').map((line) => line.split(','));
    return lines.map((line) => Object.fromEntries(names.map((name, k) => [name, line[k]])));
  };
  execFileSync(player, [pack, '--headless', '--no-draw', '--seconds', '0.1', '--trajectories', path.join(folder, 'people.csv'), '--metrics',
    path.join(folder, 'metrics.csv')]);
  const people = rows('people.csv').filter((row) => row.frame === '0')
    .map((row) => ({avatar: row.avatar, at: [row.x_m, row.y_m, row.z_m].map(Number), heading_rad: Number(row.heading_rad)}));
  const [{camera_x_m, camera_y_m, camera_yaw_rad, camera_fov_rad}] = rows('metrics.csv');
  fs.rmSync(folder, {recursive: true});
  return {people, camera: {at: [Number(camera_x_m), Number(camera_y_m)], yaw_rad: Number(camera_yaw_rad), fov_rad: Number(camera_fov_rad)}};
}

// The three.js page; it tells what it has drawn in globalThis.drawn.
const threePage = `<!doctype html><meta charset="utf-8"><style>body{margin:0}</style>
<script type="importmap">{"imports": {"three": "/modules/three/build/three.module.js", "three/addons/": "/modules/three/examples/jsm/",
"@three.ez/instanced-mesh": "/modules/@three.ez/instanced-mesh/build/index.js", "bvh.js": "/modules/bvh.js/build/index.js"}}</script>
<script type="module">
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';
import {InstancedMesh2} from '@three.ez/instanced-mesh';
const {people, camera: seen, scale} = await (await fetch('/places.json')).json();
const renderer = new THREE.WebGLRenderer({antialias: false});
renderer.setPixelRatio(scale);
renderer.setSize(${kWidth_px}, ${kHeight_px});
document.body.append(renderer.domElement);
const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder)
  .setDRACOLoader(new DRACOLoader().setDecoderPath('/modules/three/examples/jsm/libs/draco/'));
const gltf = await loader.loadAsync('/pack.glb');
const scene = new THREE.Scene();
scene.background = new THREE.Color(0.6, 0.7, 0.85);
scene.add(new THREE.HemisphereLight(0xffffff, 0x888877, 2), new THREE.DirectionalLight(0xffffff, 2));
scene.add(gltf.scenes.find((s) => s.name === 'town'));
const ofAvatar = new Map();
people.forEach((person) => ofAvatar.set(person.avatar, [...(ofAvatar.get(person.avatar) ?? []), person]));
let triangles = 0;
for (const [name, persons] of ofAvatar) {
  const root = gltf.scenes.find((s) => s.name === name);
  const meshes = [];
  root.getObjectByName(name + '_level0').traverse((node) => { if (node.isSkinnedMesh) meshes.push(node); });
  const mixer = new THREE.AnimationMixer(root);
  const clip = gltf.animations.find((a) => a.name === name + '_walk');
  mixer.clipAction(clip).play();
  for (const mesh of meshes) {
    const all = new InstancedMesh2(mesh.geometry, mesh.material, {capacity: persons.length, renderer});
    all.initSkeleton(mesh.skeleton, false);
    all.addInstances(persons.length, (instance, k) => {
      const [x, y, z] = persons[k].at;
      instance.position.set(x, z, -y);
      instance.quaternion.setFromAxisAngle(new THREE.Vector3(0, 1, 0), persons[k].heading_rad + Math.PI / 2);
    });
    persons.forEach((person, k) => {
      mixer.setTime(clip.duration * (k * 0.618 % 1));
      root.updateMatrixWorld(true);
      all.setBonesAt(k);
    });
    triangles += persons.length * mesh.geometry.index.count / 3;
    scene.add(all);
  }
}
const half = Math.tan(seen.fov_rad / 2) / (${kWidth_px} / ${kHeight_px});
const camera = new THREE.PerspectiveCamera(2 * Math.atan(half) * 180 / Math.PI, ${kWidth_px} / ${kHeight_px}, 0.1, 1000);
camera.position.set(seen.at[0], 1.65, -seen.at[1]);
camera.lookAt(seen.at[0] + Math.cos(seen.yaw_rad), 1.65, -seen.at[1] - Math.sin(seen.yaw_rad));
globalThis.drawn = {pictures: 0, triangles};
const gl = renderer.getContext(), pixel = new Uint8Array(4);
const draw = () => {
  renderer.render(scene, camera);
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);  // pictures that are not finished do not count
  ++globalThis.drawn.pictures;
  requestAnimationFrame(draw);
};
draw();
</script>`;

const places = placesOfAll();
const server = http.createServer((request, response) => {
  const url = request.url.split('?')[0];
  const text = {'/three.html': [threePage, 'text/html'], '/places.json': [JSON.stringify(places), 'application/json']}[url];
  if (text) return response.writeHead(200, {'Content-Type': text[1]}).end(text[0]);
  const file = url === '/pack.glb' ? pack : url.startsWith('/modules/') ? path.join(modules, url.slice(9))
    : path.join(site, url.replace(/\/$/, '/index.html').slice(1));
  if (!fs.existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, {'Content-Type': typeOf(file)});
  fs.createReadStream(file).pipe(response);
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

// Milliseconds a picture, over kSeconds or ten pictures; and a picture to look at.
async function timePictures(address, ready, count, picture) {
  const browser = await launch(600000);
  const page = await browser.newPage();
  page.on('pageerror', (e) => console.error(`three_bench.mjs: ${address}: ${e.message}`));
  await page.setViewport({width: kWidth_px, height: kHeight_px});
  await page.goto(`http://127.0.0.1:${server.address().port}${address}`);
  await page.waitForFunction(ready, {timeout: 300000});
  const before = await page.evaluate(count), began = performance.now();
  let after = before;
  while (performance.now() - began < 1000 * kSeconds || after.pictures < before.pictures + 10) {
    await new Promise((done) => setTimeout(done, 200));
    after = await page.evaluate(count);
  }
  const ms = (performance.now() - began) / (after.pictures - before.pictures);
  if (picture) await page.screenshot({path: picture});
  await browser.close();
  return {...after, ms};
}

const keep = process.env.FLANEUR_BENCH_PICTURES;
const standsAndIsComplete = () => {
  const {flaneur} = document.getElementById('tour'), state = flaneur?.state();
  if (state?.follows_tour) flaneur.takeTour(false);  // the visitor stays where the tour begins
  return state?.complete;
};
const ours = await timePictures('/', standsAndIsComplete,
  () => document.getElementById('tour').flaneur.state(), keep && path.join(keep, 'ours.png'));
places.scale = ours.resolution_scale;
const theirs = await timePictures('/three.html', () => globalThis.drawn?.pictures > 1, () => globalThis.drawn, keep && path.join(keep, 'theirs.png'));
console.log(`people                                          ${places.people.length}`);
console.log(`resolution of both, of 1280 x 720               ${ours.resolution_scale.toFixed(2)}`);
console.log(`the tour                                        ${ours.ms.toFixed(0)} ms a picture`);
console.log(`three.js, ${(theirs.triangles / 1e6).toFixed(1)} million triangles of people        ${theirs.ms.toFixed(0)} ms a picture`);
console.log(`three.js over the tour                          ${(theirs.ms / ours.ms).toFixed(1)} times`);
process.exit();
