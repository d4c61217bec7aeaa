// node validate.js [--schema FILE.json] PACK.glb ...
// Exits 1 when the Khronos validator finds an error or a warning, when the root extension FLANEUR_tour does not
// follow the JSON Schema, or when an impostor's picture is no sound KTX2.
'use strict';
const fs = require('fs');
const validator = require('gltf-validator');
const {ktxFindings} = require('./ktx.js');

const SEVERITIES = ['error', 'warning'];

function chunks(bytes) {
  const jsonLength = bytes.readUInt32LE(12);
  return {gltf: JSON.parse(bytes.subarray(20, 20 + jsonLength).toString('utf8')), binary: bytes.subarray(20 + jsonLength + 8)};
}

async function tourFindings(bytes, schemaFile) {
  const Ajv = require('ajv/dist/2020');
  const validate = new Ajv({allErrors: true, strict: true}).compile(JSON.parse(fs.readFileSync(schemaFile, 'utf8')));
  const {gltf, binary} = chunks(bytes);
  const extension = gltf.extensions && gltf.extensions.FLANEUR_tour;
  if (!extension) return ['no root extension FLANEUR_tour'];
  const found = validate(extension) ? [] : validate.errors.map((e) => `schema: ${e.instancePath} ${e.message}`);
  return found.concat(await ktxFindings(gltf, binary));
}

async function findings(file, schemaFile) {
  const bytes = fs.readFileSync(file);
  const report = await validator.validateBytes(new Uint8Array(bytes), {uri: file, maxIssues: 1000});
  const found = report.issues.messages.filter((m) => m.severity < SEVERITIES.length)
      .map((m) => `${SEVERITIES[m.severity]} ${m.code} ${m.pointer || ''}: ${m.message}`);
  return schemaFile ? found.concat(await tourFindings(bytes, schemaFile)) : found;
}

async function main(argv) {
  const schemaFile = argv[0] === '--schema' ? argv.splice(0, 2)[1] : null;
  let failed = false;
  for (const file of argv) {
    const found = await findings(file, schemaFile);
    failed = failed || found.length > 0;
    console.log(found.length ? `${file}: ${found.length} findings\n  ${found.slice(0, 20).join('\n  ')}` : `${file}: valid`);
  }
  process.exitCode = failed ? 1 : 0;
}

main(process.argv.slice(2));
