// What the tests and benchmarks of the page share: a browser without a graphics card, and what a plain host calls files.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import puppeteer from 'puppeteer-core';

const kFlags = ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const kTypes = {'.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.jpg': 'image/jpeg',
  '.wasm': 'application/wasm'};

export const launch = (timeout_ms = 300000, ...flags) =>
  puppeteer.launch({executablePath: '/usr/bin/chromium', args: [...kFlags, ...flags], protocolTimeout: timeout_ms});

export const typeOf = (file) => kTypes[path.extname(file)] ?? 'application/octet-stream';

// A plain static host; `change` may answer otherwise: {body}, {cut: bytes} or {status}.
export function serve(folder, change = () => null) {
  const asked = [];
  const server = http.createServer((request, response) => {
    const name = decodeURI(request.url.split('?')[0]).replace(/\/$/, '/index.html').slice(1);
    asked.push(name);
    const file = path.join(folder, name), other = change(name);
    if (other?.status || !fs.existsSync(file)) return response.writeHead(other?.status ?? 404).end();
    const body = other?.body ?? fs.readFileSync(file);
    response.writeHead(200, {'Content-Type': typeOf(file), 'Content-Length': body.length});
    if (other?.cut === undefined) return response.end(body);
    response.write(body.subarray(0, other.cut), () => response.destroy());
  });
  return new Promise((ready) => server.listen(0, '127.0.0.1', () => ready({
    server, asked, url: `http://127.0.0.1:${server.address().port}/`,
    close: () => new Promise((done) => { server.closeAllConnections(); server.close(done); })})));
}
