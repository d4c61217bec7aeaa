#include "pipeline/io/gltf_accessor.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

// More than any mesh of ours, few enough that a broken count does not exhaust memory.
constexpr size_t kMaxElements = size_t{1} << 28;

template <typename T>
double Load(const uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

double LoadComponent(const uint8_t* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return Load<int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return Load<uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return Load<int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return Load<uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return Load<uint32_t>(bytes);
    default:
      return Load<float>(bytes);
  }
}

// The factor of a normalised integer, 1 for others.
double NormalizedScale(const tinygltf::Accessor& accessor) {
  if (!accessor.normalized) return 1;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return 1 / 127.0;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1 / 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return 1 / 32767.0;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 1 / 65535.0;
    default:
      return 1;
  }
}

bool KnownComponentType(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT ||
         (type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

// The bytes of `count` elements `stride` apart, each `size` long, from `offset` of the view.
Error Elements(const tinygltf::Model& model, int view, size_t offset, size_t stride, size_t size, size_t count,
               const uint8_t** first) {
  std::span<const uint8_t> bytes;
  if (Error e = BufferViewBytes(model, view, &bytes)) return e;
  if (count > 0 && (offset > bytes.size() || size > bytes.size() - offset ||
                    (count - 1) > (bytes.size() - offset - size) / stride)) {
    return Fail("accessor reaches beyond its bufferView " + std::to_string(view));
  }
  *first = bytes.data() + offset;
  return Ok();
}

Error ReadSparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, size_t components,
                 size_t component_size, std::vector<float>* values) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || static_cast<size_t>(sparse.count) > accessor.count) {
    return Fail("sparse accessor has more values than elements");
  }
  const size_t count = static_cast<size_t>(sparse.count);
  const int index_type = sparse.indices.componentType;
  if (!KnownComponentType(index_type)) return Fail("sparse accessor has unknown index type");
  const size_t index_size = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(index_type)));
  const size_t size = component_size * components;
  const uint8_t* indices = nullptr;
  const uint8_t* data = nullptr;
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    return Fail("sparse accessor has a negative offset");
  }
  if (Error e = Elements(model, sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset), index_size,
                         index_size, count, &indices)) {
    return e;
  }
  if (Error e = Elements(model, sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset), size, size,
                         count, &data)) {
    return e;
  }
  const double scale = NormalizedScale(accessor);
  for (size_t i = 0; i < count; ++i) {
    const double index = LoadComponent(indices + i * index_size, index_type);
    if (!(index >= 0) || index >= static_cast<double>(accessor.count)) {
      return Fail("sparse accessor has an index out of range");
    }
    for (size_t c = 0; c < components; ++c) {
      const uint8_t* at = data + i * size + c * component_size;
      (*values)[static_cast<size_t>(index) * components + c] =
          static_cast<float>(LoadComponent(at, accessor.componentType) * scale);
    }
  }
  return Ok();
}

// Checks the accessor and finds its first byte (null: all zeros) and stride.
Error Locate(const tinygltf::Model& model, int index, const tinygltf::Accessor** accessor, const uint8_t** first,
             size_t* stride) {
  if (!InRange(model.accessors, index)) {
    return Fail("accessor " + std::to_string(index) + " does not exist");
  }
  const tinygltf::Accessor& a = At(model.accessors, index);
  *accessor = &a;
  *first = nullptr;
  if (!KnownComponentType(a.componentType)) return Fail("accessor has an unknown component type");
  const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type));
  if (components < 1) return Fail("accessor has an unknown type");
  if (a.count > kMaxElements) return Fail("accessor has too many elements");
  if (a.bufferView < 0) return Ok();
  const size_t size = static_cast<size_t>(components) *
                      static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(a.componentType)));
  if (static_cast<size_t>(a.bufferView) >= model.bufferViews.size()) {
    return Fail("bufferView " + std::to_string(a.bufferView) + " does not exist");
  }
  const size_t given = At(model.bufferViews, a.bufferView).byteStride;
  *stride = given > 0 ? given : size;
  if (*stride < size) return Fail("bufferView has a byteStride shorter than its elements");
  return Elements(model, a.bufferView, a.byteOffset, *stride, size, a.count, first);
}

}  // namespace

Error BufferViewBytes(const tinygltf::Model& model, int view, std::span<const uint8_t>* bytes) {
  if (!InRange(model.bufferViews, view)) {
    return Fail("bufferView " + std::to_string(view) + " does not exist");
  }
  const tinygltf::BufferView& v = At(model.bufferViews, view);
  if (!InRange(model.buffers, v.buffer)) {
    return Fail("buffer " + std::to_string(v.buffer) + " does not exist");
  }
  const auto& data = At(model.buffers, v.buffer).data;
  if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset) {
    return Fail("bufferView " + std::to_string(view) + " reaches beyond its buffer");
  }
  *bytes = {data.data() + v.byteOffset, v.byteLength};
  return Ok();
}

Error ReadFloats(const tinygltf::Model& model, int index, int components, std::vector<float>* values) {
  const tinygltf::Accessor* a = nullptr;
  const uint8_t* first = nullptr;
  size_t stride = 0;
  if (Error e = Locate(model, index, &a, &first, &stride)) return e;
  const int own = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a->type));
  if (components == 0) components = own;
  if (own != components) {
    return Fail("accessor " + std::to_string(index) + " has " + std::to_string(own) + " components instead of " +
                std::to_string(components));
  }
  const size_t size = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(a->componentType)));
  const double scale = NormalizedScale(*a);
  const double lowest = a->normalized ? -1 : std::numeric_limits<double>::lowest();
  const auto width = static_cast<size_t>(components);
  values->assign(a->count * width, 0.0f);
  for (size_t i = 0; first != nullptr && i < a->count; ++i) {
    for (size_t c = 0; c < width; ++c) {
      const uint8_t* at = first + i * stride + c * size;
      const double value = LoadComponent(at, a->componentType) * scale;
      // Not std::max: a NaN has to come through, to be reported.
      (*values)[i * width + c] = static_cast<float>(value < lowest ? lowest : value);
    }
  }
  if (a->sparse.isSparse) return ReadSparse(model, *a, width, size, values);
  return Ok();
}

Error ReadIndices(const tinygltf::Model& model, int index, std::vector<uint32_t>* indices) {
  const tinygltf::Accessor* a = nullptr;
  const uint8_t* first = nullptr;
  size_t stride = 0;
  if (Error e = Locate(model, index, &a, &first, &stride)) return e;
  const int type = a->componentType;
  const bool is_index = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                        type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (a->type != TINYGLTF_TYPE_SCALAR || !is_index || first == nullptr || a->sparse.isSparse) {
    return Fail("accessor " + std::to_string(index) + " cannot be a list of indices");
  }
  indices->resize(a->count);
  for (size_t i = 0; i < a->count; ++i) {
    (*indices)[i] = static_cast<uint32_t>(LoadComponent(first + i * stride, type));
  }
  return Ok();
}

}  // namespace flaneur
