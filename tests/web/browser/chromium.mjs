// What the tests and benchmarks of the page share: a browser without a graphics card, and what a plain host calls files.
import path from 'node:path';
import puppeteer from 'puppeteer-core';

const kFlags = ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const kTypes = {'.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.jpg': 'image/jpeg',
  '.wasm': 'application/wasm'};

export const launch = (timeout_ms = 300000, ...flags) =>
  puppeteer.launch({executablePath: '/usr/bin/chromium', args: [...kFlags, ...flags], protocolTimeout: timeout_ms});

export const typeOf = (file) => kTypes[path.extname(file)] ?? 'application/octet-stream';
