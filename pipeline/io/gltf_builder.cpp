#include "pipeline/io/gltf_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/io/clip_keys.h"
#include "pipeline/io/encode_avatar.h"
#include "pipeline/io/meshopt_codec.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using nlohmann::json;

constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;  // glTF component types
constexpr int kSignedShort = 5122;
constexpr int kTimeExponent = -15;  // keys' times are rounded to that power of two, 31 us
constexpr float kMaxTime_s = 250;   // that 24 bits hold so; longer clips keep floats
constexpr size_t kGlbHeader_bytes = 12, kChunkHeader_bytes = 8;
constexpr int kVertices = 34962, kIndices = 34963;  // glTF bufferView targets

json Numbers(Vec3 v) { return {v.x, v.y, v.z}; }
json Numbers(Vec4 v) { return {v.x, v.y, v.z, v.w}; }
json Numbers(Quat q) { return {q.x, q.y, q.z, q.w}; }

template <typename T>
std::span<const uint8_t> Bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
}

// Keys rounded for one of EXT_meshopt_compression's filters, compressed together.
struct KeyStream {
  const char* filter = "";
  size_t stride = 0;
  std::vector<uint8_t> bytes;
  std::map<std::string, int> accessors;  // by their bytes: equal arrays are stored once
};

// Floats that share one bufferView: the validator wants one kind of use each.
struct FloatPool {
  std::vector<float> values;
  std::map<std::vector<float>, int> accessors;  // equal arrays are stored once
  std::vector<int> waiting;                     // accessors whose bufferView is still to come
};

void PutU32(uint32_t value, std::vector<uint8_t>* out) {
  for (int i = 0; i < 4; ++i) out->push_back(static_cast<uint8_t>(value >> (8 * i)));
}

}  // namespace

struct GltfBuilder::Impl {
  json root = {{"asset", {{"version", "2.0"}, {"generator", "Flaneur"}}}};
  std::vector<uint8_t> earlier;  // a file that is gone on with; of it this is its binary part
  size_t earlier_at = 0, earlier_bytes = 0;
  std::vector<uint8_t> binary;  // after that
  std::set<std::string> used, required;
  std::map<std::string, int> images;  // by their bytes
  std::map<std::pair<int, bool>, int> textures;
  FloatPool binds, key_times, key_values;
  KeyStream rounded_times{"EXPONENTIAL", 4, {}, {}};
  KeyStream rounded_rotations{"QUATERNION", 8, {}, {}}, rounded_vectors{"EXPONENTIAL", 12, {}, {}};
  size_t fallback_bytes = 0;  // of the buffer that compressed views stand for
  Error problem;              // the first broken JSON given, reported by Finish

  int Add(const char* list, json item) {
    root[list].push_back(std::move(item));
    return Count(root[list]) - 1;
  }

  size_t BinarySize() const { return earlier_bytes + binary.size(); }
  void Pad() { binary.resize(binary.size() + (4 - BinarySize() % 4) % 4); }
  std::span<const uint8_t> Earlier() const { return std::span(earlier).subspan(earlier_at, earlier_bytes); }

  int AddView(std::span<const uint8_t> bytes, int target) {
    Pad();
    json view = {{"buffer", 0}, {"byteOffset", BinarySize()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return Add("bufferViews", std::move(view));
  }

  json ParseObject(const std::string& what, std::string_view text) {
    json value = json::parse(text, nullptr, false);
    if (value.is_object()) return value;
    if (!problem) problem = Fail("glTF: " + what + " is not a JSON object");
    return json::object();
  }

  int AddFloats(FloatPool* pool, const std::vector<float>& values, const char* type, size_t components, bool bounds) {
    // Equal numbers as another type would be another accessor; the component count tells them
    // apart.
    std::vector<float> identity = values;
    identity.push_back(static_cast<float>(components));
    const auto [it, is_new] = pool->accessors.try_emplace(std::move(identity), -1);
    if (!is_new) return it->second;
    json accessor = {{"byteOffset", pool->values.size() * sizeof(float)},
                     {"componentType", kFloat},
                     {"count", values.size() / components},
                     {"type", type}};
    if (bounds) {
      accessor["min"] = {*std::min_element(values.begin(), values.end())};
      accessor["max"] = {*std::max_element(values.begin(), values.end())};
    }
    pool->values.insert(pool->values.end(), values.begin(), values.end());
    it->second = Add("accessors", std::move(accessor));
    pool->waiting.push_back(it->second);
    return it->second;
  }

  void FlushPool(FloatPool* pool) {
    if (pool->waiting.empty()) return;
    const int view = AddView(Bytes(pool->values), 0);
    for (const int accessor : pool->waiting) {
      At(root["accessors"], accessor)["bufferView"] = view;
    }
    pool->waiting.clear();
  }

  // Returns the accessor, whose bufferView is still to come.
  int AddRounded(KeyStream* stream, std::span<const uint8_t> bytes, json accessor) {
    const auto [it, is_new] = stream->accessors.try_emplace(std::string(bytes.begin(), bytes.end()), -1);
    if (!is_new) return it->second;
    accessor["byteOffset"] = stream->bytes.size();
    accessor["count"] = bytes.size() / stream->stride;
    stream->bytes.insert(stream->bytes.end(), bytes.begin(), bytes.end());
    return it->second = Add("accessors", std::move(accessor));
  }

  void FlushStream(const KeyStream& stream) {
    if (stream.accessors.empty()) return;
    const int view = AddView(EncodeMeshopt(stream.bytes, stream.stride), 0);
    json& item = At(root["bufferViews"], view);
    json packed = item;
    packed["byteStride"] = stream.stride;
    packed["count"] = stream.bytes.size() / stream.stride;
    packed["mode"] = "ATTRIBUTES";
    packed["filter"] = stream.filter;
    item = {{"buffer", 1},
            {"byteOffset", fallback_bytes},
            {"byteLength", stream.bytes.size()},
            {"extensions", {{kMeshoptExtension, std::move(packed)}}}};
    fallback_bytes += stream.bytes.size();
    for (const auto& [bytes, accessor] : stream.accessors) {
      At(root["accessors"], accessor)["bufferView"] = view;
    }
    used.insert(kMeshoptExtension);
    required.insert(kMeshoptExtension);
  }

  // An accessor whose numbers are in the Draco data, or in `view`.
  int AddAttribute(int view, int component, const char* type, size_t count, bool normalized) {
    json accessor = {{"componentType", component}, {"count", count}, {"type", type}};
    if (view >= 0) accessor["bufferView"] = view;
    if (normalized) accessor["normalized"] = true;
    return Add("accessors", std::move(accessor));
  }

  void SetBounds(int accessor, Vec3 min, Vec3 max) {
    json& a = At(root["accessors"], accessor);
    a["min"] = Numbers(min);
    a["max"] = Numbers(max);
  }

  void AddCompressed(const DracoMesh& draco, bool byte_joints, json* primitive);
  void AddPlain(const Mesh& mesh, bool byte_joints, json* primitive);
  // What of the file stands before its binary part, which is whole then.
  Error End(std::vector<uint8_t>* head);
  int AddKeyTimes(const KeyChannel& channel);
  int AddKeyValues(const KeyChannel& channel);
};

void GltfBuilder::Impl::AddCompressed(const DracoMesh& draco, bool byte_joints, json* primitive) {
  json ids = json::object();
  json& attributes = (*primitive)["attributes"];
  const auto add = [&](int id, const char* name, int component, const char* type, bool normalized) {
    if (id < 0) return;
    ids[name] = id;
    attributes[name] = AddAttribute(-1, component, type, static_cast<size_t>(draco.vertices), normalized);
  };
  add(draco.position, "POSITION", kFloat, "VEC3", false);
  add(draco.normal, "NORMAL", kFloat, "VEC3", false);
  add(draco.uv, "TEXCOORD_0", kFloat, "VEC2", false);
  add(draco.uv1, "TEXCOORD_1", kFloat, "VEC2", false);
  add(draco.color, "COLOR_0", kFloat, "VEC4", false);
  add(draco.joints, "JOINTS_0", byte_joints ? kByte : kShort, "VEC4", false);
  add(draco.weights, "WEIGHTS_0", kByte, "VEC4", true);
  SetBounds(attributes["POSITION"], draco.min, draco.max);
  (*primitive)["indices"] = AddAttribute(-1, draco.vertices > 65535 ? kInt : kShort, "SCALAR",
                                         3 * static_cast<size_t>(draco.triangles), false);
  (*primitive)["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", AddView(draco.bytes, 0)},
                                                              {"attributes", ids}};
  used.insert("KHR_draco_mesh_compression");
  required.insert("KHR_draco_mesh_compression");
}

void GltfBuilder::Impl::AddPlain(const Mesh& mesh, bool byte_joints, json* primitive) {
  json& attributes = (*primitive)["attributes"];
  const size_t n = mesh.positions.size();
  const auto add = [&](const char* name, const auto& values, int component, const char* type, bool normalized) {
    if (values.empty()) return;
    attributes[name] = AddAttribute(AddView(Bytes(values), kVertices), component, type, n, normalized);
  };
  add("POSITION", mesh.positions, kFloat, "VEC3", false);
  add("NORMAL", mesh.normals, kFloat, "VEC3", false);
  add("TEXCOORD_0", mesh.uvs, kFloat, "VEC2", false);
  add("TEXCOORD_1", mesh.uvs1, kFloat, "VEC2", false);
  add("COLOR_0", mesh.colors, kFloat, "VEC4", false);
  std::vector<std::array<uint8_t, 4>> joints, weights;
  for (const auto& j : mesh.joints) {
    joints.push_back({static_cast<uint8_t>(j[0]), static_cast<uint8_t>(j[1]), static_cast<uint8_t>(j[2]),
                      static_cast<uint8_t>(j[3])});
  }
  for (const auto& w : mesh.weights) weights.push_back(WeightBytes(w));
  if (byte_joints) add("JOINTS_0", joints, kByte, "VEC4", false);
  if (!byte_joints) add("JOINTS_0", mesh.joints, kShort, "VEC4", false);
  add("WEIGHTS_0", weights, kByte, "VEC4", true);
  Vec3 min = mesh.positions[0], max = min;
  for (const Vec3 p : mesh.positions) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  SetBounds(attributes["POSITION"], min, max);
  if (n > 65535) {
    (*primitive)["indices"] =
        AddAttribute(AddView(Bytes(mesh.indices), kIndices), kInt, "SCALAR", mesh.indices.size(), false);
    return;
  }
  const std::vector<uint16_t> indices(mesh.indices.begin(), mesh.indices.end());
  (*primitive)["indices"] = AddAttribute(AddView(Bytes(indices), kIndices), kShort, "SCALAR", indices.size(), false);
}

int GltfBuilder::Impl::AddKeyTimes(const KeyChannel& channel) {
  if (channel.rounded.empty() || channel.times.back() > kMaxTime_s) {
    return AddFloats(&key_times, channel.times, "SCALAR", 1, true);
  }
  std::vector<uint32_t> rounded;
  for (const float time : channel.times) rounded.push_back(FilteredNumber(time, kTimeExponent));
  return AddRounded(&rounded_times, Bytes(rounded),
                    {{"componentType", kFloat},
                     {"type", "SCALAR"},
                     {"min", {Unfiltered(rounded.front())}},
                     {"max", {Unfiltered(rounded.back())}}});
}

int GltfBuilder::Impl::AddKeyValues(const KeyChannel& channel) {
  const bool rotates = channel.path == "rotation";
  const char* type = rotates ? "VEC4" : "VEC3";
  if (channel.rounded.empty()) {
    std::vector<float> values;
    for (const Vec4& v : channel.values) {
      values.insert(values.end(), &v.x, &v.x + (rotates ? 4 : 3));
    }
    return AddFloats(&key_values, values, type, rotates ? 4 : 3, false);
  }
  json accessor = {{"componentType", rotates ? kSignedShort : kFloat}, {"type", type}};
  if (rotates) accessor["normalized"] = true;
  return AddRounded(rotates ? &rounded_rotations : &rounded_vectors, channel.rounded, std::move(accessor));
}

GltfBuilder::GltfBuilder() : impl_(std::make_unique<Impl>()) {}
GltfBuilder::~GltfBuilder() = default;
GltfBuilder::GltfBuilder(GltfBuilder&&) noexcept = default;
GltfBuilder& GltfBuilder::operator=(GltfBuilder&&) noexcept = default;

int GltfBuilder::AddImage(const Image& image) {
  const auto [it, is_new] = impl_->images.try_emplace(std::string(image.bytes.begin(), image.bytes.end()), -1);
  if (!is_new) return it->second;
  json item = {{"bufferView", impl_->AddView(image.bytes, 0)}, {"mimeType", image.mime_type}};
  if (!image.name.empty()) item["name"] = image.name;
  return it->second = impl_->Add("images", std::move(item));
}

int GltfBuilder::AddTexture(int image, bool repeat) {
  const auto [it, is_new] = impl_->textures.try_emplace({image, repeat}, -1);
  if (!is_new) return it->second;
  const int wrap = repeat ? 10497 : 33071;
  json sampler = {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", wrap}, {"wrapT", wrap}};
  json& samplers = impl_->root["samplers"];
  int index = -1;
  for (size_t i = 0; i < samplers.size(); ++i) {
    if (samplers[i] == sampler) index = static_cast<int>(i);
  }
  if (index < 0) index = impl_->Add("samplers", std::move(sampler));
  return it->second = impl_->Add("textures", {{"sampler", index}, {"source", image}});
}

int GltfBuilder::AddMaterial(const Material& material) {
  json pbr = {{"baseColorFactor", Numbers(material.base_color)},
              {"metallicFactor", std::clamp(material.metallic, 0.0f, 1.0f)},  // sums of shares round beyond 1
              {"roughnessFactor", std::clamp(material.roughness, 0.0f, 1.0f)}};
  if (material.base_color_image >= 0) {
    pbr["baseColorTexture"] = {{"index", AddTexture(material.base_color_image)}};
  }
  json item = {{"pbrMetallicRoughness", pbr}};
  if (!material.name.empty()) item["name"] = material.name;
  if (material.normal_image >= 0) {
    item["normalTexture"] = {{"index", AddTexture(material.normal_image)}};
  }
  if (material.double_sided) item["doubleSided"] = true;
  if (material.alpha == Material::Alpha::kBlend) item["alphaMode"] = "BLEND";
  if (material.alpha == Material::Alpha::kMask) {
    item["alphaMode"] = "MASK";
    item["alphaCutoff"] = material.alpha_cutoff;
  }
  return impl_->Add("materials", std::move(item));
}

std::vector<int> GltfBuilder::AddMaterials(std::span<const Material> materials, std::span<const Image> images) {
  std::vector<int> added;
  const auto here = [&](int image) { return image < 0 ? -1 : AddImage(At(images, image)); };
  for (Material material : materials) {
    material.base_color_image = here(material.base_color_image);
    material.normal_image = here(material.normal_image);
    added.push_back(AddMaterial(material));
  }
  return added;
}

Error GltfBuilder::AddMesh(const std::string& name, const EncodedMesh& encoded, std::span<const int> materials,
                           int* mesh) {
  const std::string quoted = "mesh '" + OneLine(name) + "'";
  json primitives = json::array();
  for (const EncodedPart& part : encoded.parts) {
    json primitive = json::object();
    const int material = part.material;
    if (material >= Count(materials)) {
      return Fail(quoted + ": its material is out of range");
    }
    if (material >= 0) primitive["material"] = At(materials, material);
    if (encoded.compressed) {
      impl_->AddCompressed(part.draco, encoded.byte_joints, &primitive);
    } else {
      impl_->AddPlain(part.mesh, encoded.byte_joints, &primitive);
    }
    primitives.push_back(std::move(primitive));
  }
  if (primitives.empty()) return Fail(quoted + " has no triangle");
  json item = {{"primitives", std::move(primitives)}};
  if (!name.empty()) item["name"] = name;
  *mesh = impl_->Add("meshes", std::move(item));
  return Ok();
}

int GltfBuilder::AddNode(const GltfNode& node) {
  json item = json::object();
  if (!node.name.empty()) item["name"] = node.name;
  if (node.mesh >= 0) item["mesh"] = node.mesh;
  if (node.skin >= 0) item["skin"] = node.skin;
  const Transform& t = node.transform;
  const Transform none;
  if (Numbers(t.translation) != Numbers(none.translation)) {
    item["translation"] = Numbers(t.translation);
  }
  if (Numbers(t.rotation) != Numbers(none.rotation)) item["rotation"] = Numbers(t.rotation);
  if (Numbers(t.scale) != Numbers(none.scale)) item["scale"] = Numbers(t.scale);
  if (!node.extras.empty()) item["extras"] = impl_->ParseObject("a node's extras", node.extras);
  const int index = impl_->Add("nodes", std::move(item));
  if (node.parent >= 0) {
    At(impl_->root["nodes"], node.parent)["children"].push_back(index);
  }
  return index;
}

int GltfBuilder::AddSkin(const std::string& name, std::span<const int> joint_nodes, std::span<const Mat4> inverse_binds,
                         int skeleton_node) {
  std::vector<float> values;
  for (const Mat4& matrix : inverse_binds) {
    for (const auto& column : matrix.m) values.insert(values.end(), column.begin(), column.end());
    // What glTF asks of an affine matrix, without rounding's last digits.
    const size_t first = values.size() - 16;
    values[first + 3] = values[first + 7] = values[first + 11] = 0;
    values[first + 15] = 1;
  }
  json item = {{"joints", std::vector<int>(joint_nodes.begin(), joint_nodes.end())},
               {"inverseBindMatrices", impl_->AddFloats(&impl_->binds, values, "MAT4", 16, false)}};
  if (!name.empty()) item["name"] = name;
  if (skeleton_node >= 0) item["skeleton"] = skeleton_node;
  return impl_->Add("skins", std::move(item));
}

int GltfBuilder::AddAnimation(const std::string& name, std::span<const KeyChannel> kept,
                              std::span<const int> joint_nodes) {
  json channels = json::array(), samplers = json::array();
  for (const KeyChannel& channel : kept) {
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", joint_nodes[channel.joint]}, {"path", channel.path}}}});
    samplers.push_back({{"input", impl_->AddKeyTimes(channel)}, {"output", impl_->AddKeyValues(channel)}});
  }
  if (channels.empty()) return -1;
  json item = {{"channels", std::move(channels)}, {"samplers", std::move(samplers)}};
  if (!name.empty()) item["name"] = name;
  return impl_->Add("animations", std::move(item));
}

int GltfBuilder::AddScene(const std::string& name, std::span<const int> root_nodes) {
  json item = json::object();
  if (!name.empty()) item["name"] = name;
  if (!root_nodes.empty()) item["nodes"] = std::vector<int>(root_nodes.begin(), root_nodes.end());
  impl_->root["scene"] = 0;
  return impl_->Add("scenes", std::move(item));
}

int GltfBuilder::AddBufferView(std::span<const uint8_t> bytes) { return impl_->AddView(bytes, 0); }

void GltfBuilder::UseExtension(const std::string& name, bool required) {
  impl_->used.insert(name);
  if (required) impl_->required.insert(name);
}

void GltfBuilder::SetRootExtension(const std::string& name, std::string_view text) {
  impl_->root["extensions"][name] = impl_->ParseObject(name, text);
  UseExtension(name);
}

void GltfBuilder::SetNodeExtension(int node, const std::string& name, std::string_view text) {
  At(impl_->root["nodes"], node)["extensions"][name] = impl_->ParseObject(name, text);
  UseExtension(name);
}

void GltfBuilder::SetNodeExtras(int node, std::string_view text) {
  At(impl_->root["nodes"], node)["extras"] = impl_->ParseObject("a node's extras", text);
}

void GltfBuilder::SetLevels(int node, std::span<const int> coarser, std::span<const float> switch_heights) {
  json& item = At(impl_->root["nodes"], node);
  item["extensions"]["MSFT_lod"]["ids"] = std::vector<int>(coarser.begin(), coarser.end());
  item["extras"]["MSFT_screencoverage"] = std::vector<float>(switch_heights.begin(), switch_heights.end());
  UseExtension("MSFT_lod");
}

Error GltfBuilder::Impl::End(std::vector<uint8_t>* head) {
  for (FloatPool* pool : {&binds, &key_times, &key_values}) FlushPool(pool);
  for (const KeyStream* stream : {&rounded_times, &rounded_rotations, &rounded_vectors}) FlushStream(*stream);
  if (!used.empty()) root["extensionsUsed"] = used;
  if (!required.empty()) root["extensionsRequired"] = required;
  if (BinarySize() > 0) root["buffers"] = json::array({{{"byteLength", BinarySize()}}});
  if (fallback_bytes > 0) {
    root["buffers"].push_back(
        {{"byteLength", fallback_bytes}, {"extensions", {{kMeshoptExtension, {{"fallback", true}}}}}});
  }
  if (problem) return problem;
  std::string text;
  try {
    text = root.dump();
  } catch (const json::exception& e) {  // text that is not UTF-8
    return Fail(std::string("glTF: ") + OneLine(e.what()));
  }
  text.resize((text.size() + 3) / 4 * 4, ' ');
  Pad();
  const size_t chunks = BinarySize() == 0 ? 1 : 2;
  const size_t size = kGlbHeader_bytes + chunks * kChunkHeader_bytes + text.size() + BinarySize();
  if (size > 0xffffffffu) return Fail("glTF: more than the 4 GiB that a binary file can hold");
  const auto put = [head](size_t word) { PutU32(static_cast<uint32_t>(word), head); };
  for (const size_t word : {size_t{0x46546c67}, size_t{2}, size, text.size(), size_t{0x4e4f534a}}) put(word);
  head->insert(head->end(), text.begin(), text.end());
  if (chunks == 1) return Ok();
  put(BinarySize());
  put(0x004e4942);
  return Ok();
}

Error GltfBuilder::Finish(std::vector<uint8_t>* glb) {
  GltfBuilder done;
  std::swap(impl_, done.impl_);
  std::vector<uint8_t> head;
  if (Error e = done.impl_->End(&head)) return e;
  std::vector<uint8_t>& binary = done.impl_->binary;
  const std::span<const uint8_t> earlier = done.impl_->Earlier();
  head.insert(head.end(), earlier.begin(), earlier.end());
  binary.insert(binary.begin(), head.begin(), head.end());
  *glb = std::move(binary);
  return Ok();
}

Error GltfBuilder::Write(const std::filesystem::path& path, size_t* bytes) {
  GltfBuilder done;
  std::swap(impl_, done.impl_);
  std::vector<uint8_t> head;
  if (Error e = done.impl_->End(&head)) return e;
  const std::span<const uint8_t> parts[] = {head, done.impl_->Earlier(), done.impl_->binary};
  *bytes = 0;
  for (const auto& part : parts) *bytes += part.size();
  return WriteFile(path, parts);
}

Error GltfBuilder::Resume(std::vector<uint8_t> glb) {
  const Error broken = Fail("glTF: what is to be gone on with is no whole binary file");
  const auto word = [&glb](size_t at) {
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;) value = value << 8 | glb[at + i];
    return size_t{value};
  };
  *this = GltfBuilder();
  if (glb.size() < kGlbHeader_bytes + kChunkHeader_bytes || word(8) != glb.size()) return broken;
  const size_t text_size = word(kGlbHeader_bytes), text_at = kGlbHeader_bytes + kChunkHeader_bytes;
  if (text_size > glb.size() - text_at) return broken;
  Impl& impl = *impl_;
  impl.root = json::parse(glb.begin() + static_cast<std::ptrdiff_t>(text_at),
                          glb.begin() + static_cast<std::ptrdiff_t>(text_at + text_size), nullptr, false);
  if (!impl.root.is_object()) return broken;
  const json buffers = impl.root.value("buffers", json::array());
  impl.root.erase("buffers");
  if (!buffers.empty()) {
    const size_t at = text_at + text_size + kChunkHeader_bytes, size = buffers[0].value("byteLength", size_t{0});
    if (at > glb.size() || size > glb.size() - at) return broken;
    impl.earlier = std::move(glb);
    impl.earlier_at = at;
    impl.earlier_bytes = size;
  }
  if (buffers.size() > 1) impl.fallback_bytes = buffers[1].value("byteLength", size_t{0});
  impl.used = impl.root.value("extensionsUsed", std::set<std::string>{});
  impl.required = impl.root.value("extensionsRequired", std::set<std::string>{});
  return Ok();
}

}  // namespace flaneur
