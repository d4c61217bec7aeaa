// The KTX2 pictures of a tour pack's impostors, read by ktx-parse: sizes, formats, mip levels.
'use strict';

// Vulkan's format: bytes a block of 4 x 4 texels, and the colour model of Khronos's data format descriptor.
const FORMATS = {139: [8, 131], 141: [16, 132], 145: [16, 134], 146: [16, 134]};  // BC4, BC5, BC7 linear and sRGB
const NONE = 0, ZSTANDARD = 2;  // supercompression
const VIEWS = ['albedo_view', 'normal_view', 'depth_view', 'motion_view'];

function levelFindings(picture, name) {
  const [blockBytes] = FORMATS[picture.vkFormat];
  const found = [];
  picture.levels.forEach((level, k) => {
    const blocks = (size) => Math.ceil(Math.max(1, size >> k) / 4);
    const wanted = blocks(picture.pixelWidth) * blocks(picture.pixelHeight) * blockBytes;
    const bytes = picture.supercompressionScheme === NONE ? level.levelData.byteLength : level.uncompressedByteLength;
    if (bytes !== wanted) found.push(`${name}: level ${k} has ${bytes} bytes, not ${wanted}`);
    if (picture.supercompressionScheme === ZSTANDARD && level.levelData.byteLength > wanted + 64)
      found.push(`${name}: level ${k} is larger packed than as it is`);
  });
  return found;
}

function pictureFindings(picture, impostor, view, name) {
  if (!FORMATS[picture.vkFormat]) return [`${name}: format ${picture.vkFormat}`];
  const found = [];
  if (![NONE, ZSTANDARD].includes(picture.supercompressionScheme)) found.push(`${name}: supercompression ${picture.supercompressionScheme}`);
  const share = view === 'motion_view' ? 2 : 1;  // of the atlas's size: motion is smooth
  if (picture.pixelWidth !== impostor.width_px / share || picture.pixelHeight !== impostor.height_px / share) {
    found.push(`${name}: ${picture.pixelWidth} x ${picture.pixelHeight} is not the atlas's size`);
  }
  if (picture.levels.length !== (share === 1 ? 6 : 5)) found.push(`${name}: ${picture.levels.length} levels`);
  const model = picture.dataFormatDescriptor[0].colorModel;
  if (model !== FORMATS[picture.vkFormat][1]) found.push(`${name}: colour model ${model} does not go with format ${picture.vkFormat}`);
  return found.concat(levelFindings(picture, name));
}

// gltf: the pack's JSON; binary: its binary chunk.
async function ktxFindings(gltf, binary) {
  const {read} = await import('ktx-parse');
  const found = [];
  for (const avatar of gltf.extensions.FLANEUR_tour.avatars) {
    for (const view of VIEWS) {
      const name = `${avatar.name}.${view}`;
      const {byteOffset = 0, byteLength} = gltf.bufferViews[avatar.impostor[view]];
      try {
        found.push(...pictureFindings(read(new Uint8Array(binary.subarray(byteOffset, byteOffset + byteLength))), avatar.impostor, view, name));
      } catch (error) {
        found.push(`${name}: ${error.message}`);
      }
    }
  }
  return found;
}

module.exports = {ktxFindings};
