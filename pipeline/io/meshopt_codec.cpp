#include "pipeline/io/meshopt_codec.h"

#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "pipeline/io/gltf_accessor.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// No codec makes its input smaller than that: a broken count must not exhaust memory.
constexpr size_t kMaxBytesAByte = 64;

struct Compressed {
  size_t count = 0, stride = 0;
  std::string mode, filter;
};

Error ReadCompressed(const tinygltf::Value& extension, size_t bytes, Compressed* out) {
  if (!extension.IsObject()) return Fail("has a broken extension");
  const auto number = [&](const char* key) {
    const auto& value = extension.Get(key);
    return value.IsNumber() ? value.GetNumberAsDouble() : -1;
  };
  const auto text = [&](const char* key) {
    const auto& value = extension.Get(key);
    return value.IsString() ? value.Get<std::string>() : std::string();
  };
  const double count = number("count"), stride = number("byteStride");
  if (!(count >= 0 && stride >= 1 && stride <= 256) || count * stride > static_cast<double>(bytes) * kMaxBytesAByte) {
    return Fail("has a broken count or byteStride");
  }
  out->count = static_cast<size_t>(count);
  out->stride = static_cast<size_t>(stride);
  out->mode = text("mode");
  out->filter = text("filter");
  return Ok();
}

bool Decoded(const Compressed& view, std::span<const uint8_t> bytes, uint8_t* out) {
  const bool wide = view.stride == 4, index = wide || view.stride == 2;
  if (view.mode == "ATTRIBUTES" && view.stride % 4 == 0) {
    return meshopt_decodeVertexBuffer(out, view.count, view.stride, bytes.data(), bytes.size()) == 0;
  }
  if (view.mode == "TRIANGLES" && index && view.count % 3 == 0) {
    return meshopt_decodeIndexBuffer(out, view.count, view.stride, bytes.data(), bytes.size()) == 0;
  }
  if (view.mode == "INDICES" && index) {
    return meshopt_decodeIndexSequence(out, view.count, view.stride, bytes.data(), bytes.size()) == 0;
  }
  return false;
}

bool Unfilter(const Compressed& view, uint8_t* bytes) {
  if (view.filter.empty() || view.filter == "NONE") return true;
  if (view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) {
    meshopt_decodeFilterOct(bytes, view.count, view.stride);
  } else if (view.filter == "QUATERNION" && view.stride == 8) {
    meshopt_decodeFilterQuat(bytes, view.count, view.stride);
  } else if (view.filter == "EXPONENTIAL" && view.stride % 4 == 0) {
    meshopt_decodeFilterExp(bytes, view.count, view.stride);
  } else {
    return false;
  }
  return true;
}

Error DecodeView(tinygltf::Model* model, int index) {
  tinygltf::BufferView& view = At(model->bufferViews, index);
  const auto found = view.extensions.find(kMeshoptExtension);
  if (found == view.extensions.end()) return Ok();
  std::span<const uint8_t> bytes;
  if (Error e = BufferViewBytes(*model, index, &bytes)) return e;
  const std::string name = "bufferView " + std::to_string(index);
  Compressed compressed;
  if (Error e = ReadCompressed(found->second, bytes.size(), &compressed)) {
    return Fail(name + " " + e.message);
  }
  tinygltf::Buffer buffer;
  // Filters work on four elements at once.
  buffer.data.resize((compressed.count + 3) / 4 * 4 * compressed.stride);
  if (!Decoded(compressed, bytes, buffer.data.data()) || !Unfilter(compressed, buffer.data.data())) {
    return Fail(name + " holds broken compressed data");
  }
  view.byteOffset = 0;
  view.byteLength = compressed.count * compressed.stride;
  view.buffer = Count(model->buffers);
  model->buffers.push_back(std::move(buffer));
  return Ok();
}

}  // namespace

Error DecodeMeshoptViews(tinygltf::Model* model) {
  for (size_t i = 0; i < model->bufferViews.size(); ++i) {
    if (Error e = DecodeView(model, static_cast<int>(i))) return e;
  }
  return Ok();
}

std::vector<uint8_t> EncodeMeshopt(std::span<const uint8_t> bytes, size_t stride) {
  const size_t count = bytes.size() / stride;
  std::vector<uint8_t> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), bytes.data(), count, stride));
  return out;
}

std::array<int16_t, 4> FilteredRotation(Vec4 rotation, int bits) {
  std::array<int16_t, 4> out{};
  meshopt_encodeFilterQuat(out.data(), 1, sizeof out, bits, &rotation.x);
  return out;
}

uint32_t FilteredNumber(float value, int exponent) {
  const auto whole = static_cast<int32_t>(std::lround(std::ldexp(value, -exponent)));
  return (static_cast<uint32_t>(whole) & 0xffffff) | static_cast<uint32_t>(exponent) << 24;
}

Vec4 Unfiltered(const std::array<int16_t, 4>& rotation) {
  std::array<int16_t, 16> four{};  // the filter may work on four at once
  std::copy(rotation.begin(), rotation.end(), four.begin());
  meshopt_decodeFilterQuat(four.data(), 1, sizeof rotation);
  const auto share = [&](size_t i) { return static_cast<float>(four[i]) / 32767; };
  return {share(0), share(1), share(2), share(3)};
}

float Unfiltered(uint32_t number) {
  const auto whole = static_cast<int32_t>(number << 8) >> 8;
  return std::ldexp(static_cast<float>(whole), static_cast<int8_t>(number >> 24));
}

}  // namespace flaneur
