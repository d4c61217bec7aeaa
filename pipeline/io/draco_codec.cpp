#include "pipeline/io/draco_codec.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "runtime/base/draco_size.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

constexpr int kPositionBits = 14;  // 0.12 mm over 2 m

// Decodes without exceptions reaching the caller: Draco itself has none, but allocates what a
// broken header asks for.
Error DecodeMesh(std::span<const uint8_t> bytes, std::unique_ptr<draco::Mesh>* mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) return Fail(std::string("Draco data: ") + result.status().error_msg());
    *mesh = std::move(result).value();
  } catch (const std::exception& e) {
    return Fail(std::string("Draco data: ") + e.what());
  }
  return *mesh ? Ok() : Fail("Draco data: no mesh");
}

Error CopyAttribute(const draco::Mesh& mesh, DracoAttribute* out) {
  const draco::PointAttribute* a = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(out->id));
  if (a == nullptr) return Fail("Draco data: no attribute " + std::to_string(out->id));
  out->components = a->num_components();
  out->normalized = a->normalized();
  const uint32_t points = mesh.num_points();
  out->values.resize(static_cast<size_t>(points) * static_cast<size_t>(out->components));
  for (uint32_t p = 0; p < points; ++p) {
    const auto index = a->mapped_index(draco::PointIndex(p));
    float* at = out->values.data() + static_cast<size_t>(p) * static_cast<size_t>(out->components);
    if (!a->ConvertValue<float>(index, static_cast<int8_t>(out->components), at)) {
      return Fail("Draco data: attribute " + std::to_string(out->id) + " cannot be read");
    }
  }
  return Ok();
}

// Adds one attribute of `count` values, `data` packed.
int AddAttribute(draco::Mesh* mesh, draco::GeometryAttribute::Type type, draco::DataType data_type, int components,
                 bool normalized, const void* data, size_t count) {
  draco::GeometryAttribute attribute;
  const size_t stride = static_cast<size_t>(components) * static_cast<size_t>(draco::DataTypeLength(data_type));
  attribute.Init(type, nullptr, static_cast<uint8_t>(components), data_type, normalized, static_cast<int64_t>(stride),
                 0);
  const int id = mesh->AddAttribute(attribute, true, static_cast<uint32_t>(count));
  mesh->attribute(id)->buffer()->Write(0, data, stride * count);
  return id;
}

template <typename T>
int AddFloats(draco::Mesh* mesh, draco::GeometryAttribute::Type type, const std::vector<T>& data) {
  if (data.empty()) return -1;
  return AddAttribute(mesh, type, draco::DT_FLOAT32, sizeof(T) / sizeof(float), false, data.data(), data.size());
}

int AddJoints(draco::Mesh* mesh, const Mesh& in, bool bytes) {
  if (in.joints.empty()) return -1;
  const auto generic = draco::GeometryAttribute::GENERIC;
  if (!bytes) {
    return AddAttribute(mesh, generic, draco::DT_UINT16, 4, false, in.joints.data(), in.joints.size());
  }
  std::vector<std::array<uint8_t, 4>> joints(in.joints.size());
  for (size_t i = 0; i < joints.size(); ++i) {
    for (size_t k = 0; k < 4; ++k) joints[i][k] = static_cast<uint8_t>(in.joints[i][k]);
  }
  return AddAttribute(mesh, generic, draco::DT_UINT8, 4, false, joints.data(), joints.size());
}

int AddWeights(draco::Mesh* mesh, const Mesh& in) {
  if (in.weights.empty()) return -1;
  std::vector<std::array<uint8_t, 4>> weights(in.weights.size());
  std::transform(in.weights.begin(), in.weights.end(), weights.begin(), WeightBytes);
  return AddAttribute(mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 4, true, weights.data(),
                      weights.size());
}

void AddFaces(const Mesh& in, draco::Mesh* mesh) {
  const size_t faces = in.indices.size() / 3;
  mesh->SetNumFaces(faces);
  for (size_t f = 0; f < faces; ++f) {
    draco::Mesh::Face face;
    for (size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(in.indices[3 * f + k]);
    mesh->SetFace(draco::FaceIndex(static_cast<uint32_t>(f)), face);
  }
}

// Draco writes a grid down with six digits after the point. Rounded outwards here, or what lies at its least would come
// to lie outside, where Draco refuses uvs.
PositionGrid AsWrittenDown(const PositionGrid& grid) {
  constexpr double kUnit = 1e-6;
  const auto down = [](float a) { return static_cast<float>(std::floor(static_cast<double>(a) / kUnit) * kUnit); };
  const double size_m = (std::ceil(static_cast<double>(grid.size_m) / kUnit) + 1) * kUnit;
  return {{down(grid.min.x), down(grid.min.y), down(grid.min.z)}, static_cast<float>(size_m)};
}

// What a reader will see: counts and bounds after Draco has merged, reordered and rounded.
Error MeasureDecoded(DracoMesh* out) {
  DracoAttribute position{out->position, 0, false, {}};
  std::vector<uint32_t> indices;
  if (Error e = DecodeDraco(out->bytes, {&position, 1}, &indices)) return e;
  out->vertices = static_cast<int>(position.values.size() / 3);
  out->triangles = static_cast<int>(indices.size() / 3);
  out->min = out->max = {position.values[0], position.values[1], position.values[2]};
  for (size_t i = 0; i < position.values.size(); i += 3) {
    const float* v = &position.values[i];
    out->min = {std::min(out->min.x, v[0]), std::min(out->min.y, v[1]), std::min(out->min.z, v[2])};
    out->max = {std::max(out->max.x, v[0]), std::max(out->max.y, v[1]), std::max(out->max.z, v[2])};
  }
  return Ok();
}

}  // namespace

Error DecodeDraco(std::span<const uint8_t> bytes, std::span<DracoAttribute> attributes,
                  std::vector<uint32_t>* indices) {
  const auto size = DracoSizeOf(bytes);
  if (!size) return Fail("Draco data is broken, or of a kind that is not read: write it anew, without metadata");
  const uint64_t most = kFreeDracoFaces + kDracoFacesAByte * bytes.size();
  if (size->vertices > most || size->faces > most)
    return Fail("Draco data asks for far more triangles than its size is worth");
  std::unique_ptr<draco::Mesh> mesh;
  if (Error e = DecodeMesh(bytes, &mesh)) return e;
  for (DracoAttribute& attribute : attributes) {
    if (Error e = CopyAttribute(*mesh, &attribute)) return e;
  }
  indices->clear();
  indices->reserve(size_t{3} * mesh->num_faces());
  for (uint32_t f = 0; f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& p : mesh->face(draco::FaceIndex(f))) {
      indices->push_back(p.value());
    }
  }
  return Ok();
}

std::array<uint8_t, 4> WeightBytes(const std::array<float, 4>& weights) {
  std::array<uint8_t, 4> bytes{};
  std::array<float, 4> rest{};
  int sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    const float scaled = std::clamp(weights[i], 0.0f, 1.0f) * 255;
    bytes[i] = static_cast<uint8_t>(scaled);
    // A weight of exactly 0 gets no share of the remainder.
    rest[i] = weights[i] > 0 ? scaled - static_cast<float>(bytes[i]) : -1;
    sum += bytes[i];
  }
  for (; sum < 255; ++sum) {
    const size_t i = static_cast<size_t>(std::max_element(rest.begin(), rest.end()) - rest.begin());
    ++bytes[i];
    rest[i] -= 1;
  }
  return bytes;
}

Error EncodeDraco(const Mesh& in, const DracoOptions& options, const PositionGrid& around, bool byte_joints,
                  DracoMesh* out) {
  using Attribute = draco::GeometryAttribute;
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<uint32_t>(in.positions.size()));
  out->position = AddFloats(&mesh, Attribute::POSITION, in.positions);
  out->normal = AddFloats(&mesh, Attribute::NORMAL, in.normals);
  out->uv = AddFloats(&mesh, Attribute::TEX_COORD, in.uvs);
  out->uv1 = AddFloats(&mesh, Attribute::TEX_COORD, in.uvs1);
  out->color = AddFloats(&mesh, Attribute::COLOR, in.colors);
  out->joints = AddJoints(&mesh, in, byte_joints);
  out->weights = AddWeights(&mesh, in);
  AddFaces(in, &mesh);
  // Edgebreaker follows shared positions across seams; without this each seam would cut the
  // surface.
  if (!mesh.DeduplicateAttributeValues()) return Fail("Draco refuses the attributes");
  mesh.DeduplicatePointIds();

  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(options.speed, options.speed);
  const PositionGrid grid = AsWrittenDown(around);
  const float origin[3] = {grid.min.x, grid.min.y, grid.min.z};
  const int position_bits = options.position_bits > 0 ? options.position_bits : kPositionBits;
  encoder.SetAttributeExplicitQuantization(out->position, position_bits, 3, origin, grid.size_m);
  if (out->normal >= 0) encoder.SetAttributeQuantization(out->normal, options.normal_bits);
  for (const int id : {out->uv, out->uv1}) {
    if (id >= 0) encoder.SetAttributeQuantization(id, options.uv_bits);
  }
  if (out->color >= 0) encoder.SetAttributeQuantization(out->color, options.color_bits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return Fail(std::string("Draco: ") + status.error_msg());
  out->bytes.assign(buffer.data(), buffer.data() + buffer.size());
  for (int* id : {&out->position, &out->normal, &out->uv, &out->uv1, &out->color, &out->joints, &out->weights}) {
    if (*id >= 0) *id = static_cast<int>(mesh.attribute(*id)->unique_id());
  }
  return MeasureDecoded(out);
}

}  // namespace flaneur
