#include "runtime/pack/read_mesh.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "runtime/base/draco_size.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// Gives an attribute's values by its glTF name, empty where the primitive has none.
using AttributeSource = std::function<Values(const char* name)>;

// The decoder allocates for what the data's beginning says: that must not be more than what the primitive says, which
// has been counted.
void CheckDracoBeginning(std::span<const uint8_t> bytes, const MeshSize& most) {
  const auto size = DracoSizeOf(bytes);
  if (!size) throw PackRefused("holds Draco data that is broken, or of another kind");
  if (size->vertices > most.vertices || 3 * size->faces > most.indices)
    throw PackRefused("holds Draco data of more vertices or triangles than it says");
}

std::unique_ptr<draco::Mesh> DecodeDraco(const GltfFile& file, const Json& extension, const MeshSize& most) {
  const auto view = BufferView(file, Member(extension, "bufferView").get<int>());
  CheckDracoBeginning(view, most);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(view.data()), view.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw PackRefused("holds Draco data that cannot be decoded: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  if (mesh.num_points() > most.vertices || 3 * uint64_t{mesh.num_faces()} > most.indices)
    throw PackRefused("holds Draco data of more vertices or triangles than it says");
  return std::move(decoded).value();
}

Values DracoAttribute(const draco::Mesh& mesh, int unique_id, const Json& accessor) {
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(unique_id));
  if (attribute == nullptr) throw PackRefused("lacks Draco attribute " + std::to_string(unique_id));
  Values values;
  values.components = attribute->num_components();
  if (values.components < 1 || values.components > 4) throw PackRefused("has a Draco attribute of odd size");
  const float scale = attribute->normalized() ? 1 : NormalizedScale(accessor);
  values.numbers.resize(static_cast<size_t>(mesh.num_points()) * static_cast<size_t>(values.components));
  for (uint32_t p = 0; p < mesh.num_points(); ++p) {
    float* out = &values.numbers[static_cast<size_t>(p) * static_cast<size_t>(values.components)];
    if (!attribute->ConvertValue<float>(attribute->mapped_index(draco::PointIndex(p)),
                                        static_cast<int8_t>(values.components), out)) {
      throw PackRefused("has a Draco attribute that cannot be read");
    }
    for (int c = 0; c < values.components; ++c) out[c] *= scale;
  }
  return values;
}

void Expect(const Values& values, size_t count, int components, const char* name) {
  if (values.components != components || values.count() != count) {
    throw PackRefused("has an attribute " + std::string(name) + " of the wrong size");
  }
  for (const float number : values.numbers) {
    if (!(std::abs(static_cast<double>(number)) <= kMostCoordinate_m))
      throw PackRefused("has an attribute " + std::string(name) + " that is not finite, or out of range");
  }
}

std::vector<Vec3> ToVec3(const Values& v) {
  std::vector<Vec3> out(v.count());
  for (size_t i = 0; i < out.size(); ++i) out[i] = {v.numbers[3 * i], v.numbers[3 * i + 1], v.numbers[3 * i + 2]};
  return out;
}

void FillColors(const Values& v, PackPrimitive* primitive) {
  const size_t n = static_cast<size_t>(v.components);
  for (size_t i = 0; i < v.count(); ++i) {
    const float* c = &v.numbers[n * i];
    primitive->colors.push_back({c[0], c[1], c[2], n == 4 ? c[3] : 1.0f});
  }
}

// A pack's are bytes that sum to 255, and come out as they went in; what others leave over goes to the heaviest.
std::array<uint8_t, 4> WeightBytes(std::span<const float, 4> weights) {
  float sum = 0;
  for (const float w : weights) sum += std::max(0.0f, w);
  if (!(sum > 0) || !std::isfinite(sum)) throw PackRefused("has a vertex without weights");
  std::array<uint8_t, 4> bytes{};
  int left = 255;
  for (size_t k = 0; k < 4; ++k) {
    bytes[k] = static_cast<uint8_t>(std::lround(std::max(0.0f, weights[k]) / sum * 255));
    left -= bytes[k];
  }
  uint8_t& heaviest = *std::max_element(bytes.begin(), bytes.end());
  heaviest = static_cast<uint8_t>(heaviest + left);
  return bytes;
}

void FillSkin(const Values& joints, const Values& weights, PackPrimitive* primitive) {
  const size_t count = primitive->positions.size();
  Expect(joints, count, 4, "JOINTS_0");
  Expect(weights, count, 4, "WEIGHTS_0");
  primitive->joints.resize(count);
  primitive->weights.resize(count);
  for (size_t i = 0; i < count; ++i) {
    for (size_t k = 0; k < 4; ++k) {
      const float joint = joints.numbers[4 * i + k];
      if (!(joint >= 0 && joint < 65536)) throw PackRefused("has a joint index out of range");
      primitive->joints[i][k] = static_cast<uint16_t>(joint);
    }
    primitive->weights[i] = WeightBytes(std::span<const float, 4>(&weights.numbers[4 * i], 4));
  }
}

void FillVertices(const AttributeSource& attribute, PackPrimitive* primitive) {
  const Values positions = attribute("POSITION");
  Expect(positions, positions.count(), 3, "POSITION");
  primitive->positions = ToVec3(positions);
  const size_t count = primitive->positions.size();
  const Values normals = attribute("NORMAL");
  if (normals.components == 0) {
    primitive->normals.assign(count, Vec3{0, 1, 0});
  } else {
    Expect(normals, count, 3, "NORMAL");
    primitive->normals = ToVec3(normals);
  }
  if (const Values uvs = attribute("TEXCOORD_0"); uvs.components != 0) {
    Expect(uvs, count, 2, "TEXCOORD_0");
    for (size_t i = 0; i < count; ++i) primitive->uvs.push_back({uvs.numbers[2 * i], uvs.numbers[2 * i + 1]});
  }
  if (const Values colors = attribute("COLOR_0"); colors.components >= 3) {
    Expect(colors, count, colors.components, "COLOR_0");
    FillColors(colors, primitive);
  }
  if (const Values joints = attribute("JOINTS_0"); joints.components != 0) {
    FillSkin(joints, attribute("WEIGHTS_0"), primitive);
  }
}

MeshSize SizeOfPrimitive(const GltfFile& file, const Json& primitive) {
  const Json& positions = Member(Member(primitive, "attributes"), "POSITION");
  return {1, CountOfValues(file, positions.get<int>()), CountOfValues(file, Member(primitive, "indices").get<int>())};
}

PackPrimitive ReadThis(const GltfFile& file, const Json& json) {
  PackPrimitive primitive;
  if (json.value("mode", 4) != 4) throw PackRefused("has a primitive that is not of triangles");
  primitive.material = IndexOrNone(json, "material", Member(file.json, "materials").size());
  const Json& attributes = Member(json, "attributes");
  const bool compressed = json.contains("extensions") && json["extensions"].contains(kDracoExtension);
  if (compressed) {
    const Json& extension = json["extensions"][kDracoExtension];
    const auto mesh = DecodeDraco(file, extension, SizeOfPrimitive(file, json));
    const Json& ids = Member(extension, "attributes");
    FillVertices(
        [&](const char* name) {
          if (!ids.contains(name)) return Values{};
          return DracoAttribute(*mesh, ids[name].get<int>(),
                                Element(file.json, "accessors", Member(attributes, name).get<int>()));
        },
        &primitive);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
      for (size_t corner = 0; corner < 3; ++corner) primitive.indices.push_back(mesh->face(f)[corner].value());
    }
  } else {
    FillVertices(
        [&](const char* name) {
          return attributes.contains(name) ? ReadAccessor(file, attributes[name].get<int>()) : Values{};
        },
        &primitive);
    primitive.indices = ReadIndices(file, Member(json, "indices").get<int>());
  }
  if (primitive.indices.size() % 3 != 0) throw PackRefused("has a number of indices that is no multiple of 3");
  for (uint32_t index : primitive.indices) {
    if (index >= primitive.positions.size()) throw PackRefused("has an index beyond the vertices");
  }
  return primitive;
}

}  // namespace

PackPrimitive ReadPrimitive(const GltfFile& file, int mesh, size_t primitive) {
  const Json& json = Element(file.json, "meshes", mesh);
  try {
    return ReadThis(file, Element(json, "primitives", static_cast<int>(primitive)));
  } catch (const std::exception& e) {
    throw PackRefused("mesh " + std::to_string(mesh) + " '" + json.value("name", "") + "' " + Complaint(e));
  }
}

PackMesh ReadMesh(const GltfFile& file, int mesh) {
  PackMesh out;
  const size_t primitives = Member(Element(file.json, "meshes", mesh), "primitives").size();
  for (size_t p = 0; p < primitives; ++p) out.primitives.push_back(ReadPrimitive(file, mesh, p));
  return out;
}

MeshSize SizeOfMesh(const GltfFile& file, int mesh) {
  MeshSize size;
  for (const Json& primitive : Member(Element(file.json, "meshes", mesh), "primitives")) {
    const MeshSize one = SizeOfPrimitive(file, primitive);
    size.primitives += one.primitives;
    size.vertices += one.vertices;
    size.indices += one.indices;
  }
  return size;
}

std::vector<int> ViewsOfMesh(const GltfFile& file, int mesh) {
  std::vector<int> views;
  const auto add = [&](const Json& accessor) {
    const Json& json = Element(file.json, "accessors", accessor.get<int>());
    if (json.contains("bufferView")) views.push_back(json["bufferView"].get<int>());
  };
  for (const Json& primitive : Member(Element(file.json, "meshes", mesh), "primitives")) {
    for (const auto& attribute : Member(primitive, "attributes").items()) add(attribute.value());
    if (primitive.contains("indices")) add(primitive["indices"]);
    const auto extensions = primitive.find("extensions");
    if (extensions != primitive.end() && extensions->contains(kDracoExtension))
      views.push_back(Member((*extensions)[kDracoExtension], "bufferView").get<int>());
  }
  std::sort(views.begin(), views.end());
  views.erase(std::unique(views.begin(), views.end()), views.end());
  return views;
}

}  // namespace flaneur
