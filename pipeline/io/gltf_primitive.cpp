#include "pipeline/io/gltf_primitive.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace flaneur {
namespace {

using Floats = std::vector<float>;

const Floats* Find(const RawPrimitive& raw, const std::string& name) {
  const auto it = raw.attributes.find(name);
  return it == raw.attributes.end() ? nullptr : &it->second;
}

Error CheckFinite(const RawPrimitive& raw, size_t vertices) {
  for (const auto& [name, values] : raw.attributes) {
    if (name == "NORMAL") continue;  // bad normals are computed anew
    for (size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) continue;
      return Fail(name + " of vertex " + std::to_string(i / (values.size() / vertices)) +
                  " is not finite; repair the mesh");
    }
  }
  return Ok();
}

Error CheckLengths(const RawPrimitive& raw, size_t vertices) {
  for (const auto& [name, values] : raw.attributes) {
    if (values.size() % vertices != 0 || values.empty()) {
      return Fail(name + " has not one value a vertex");
    }
  }
  return Ok();
}

template <typename T>
std::vector<T> Packed(const Floats& values) {
  std::vector<T> out(values.size() * sizeof(float) / sizeof(T));
  std::memcpy(static_cast<void*>(out.data()), values.data(), out.size() * sizeof(T));
  return out;
}

Error Triangles(const RawPrimitive& raw, size_t vertices, std::vector<uint32_t>* out) {
  std::vector<uint32_t> order = raw.indices;
  if (!raw.indexed) {
    order.resize(vertices);
    for (size_t i = 0; i < vertices; ++i) order[i] = static_cast<uint32_t>(i);
  }
  for (const uint32_t i : order) {
    if (i >= vertices) {
      return Fail("index " + std::to_string(i) + " is out of range, there are " + std::to_string(vertices) +
                  " vertices");
    }
  }
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    if (a != b && b != c && c != a) out->insert(out->end(), {a, b, c});
  };
  const size_t n = order.size();
  if (raw.mode == TriangleMode::kList) {
    for (size_t i = 0; i + 2 < n; i += 3) add(order[i], order[i + 1], order[i + 2]);
  } else if (raw.mode == TriangleMode::kStrip) {
    for (size_t i = 0; i + 2 < n; ++i) {
      add(order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]);
    }
  } else {
    for (size_t i = 1; i + 1 < n; ++i) add(order[0], order[i], order[i + 1]);
  }
  return Ok();
}

std::vector<Vec2> Uvs(const Floats& values, const UvSource& source) {
  std::vector<Vec2> uvs = Packed<Vec2>(values);
  const float c = std::cos(source.rotation_rad), s = std::sin(source.rotation_rad);
  for (Vec2& uv : uvs) {
    const float u = uv.x * source.scale.x, v = uv.y * source.scale.y;
    uv = {source.offset.x + c * u + s * v, source.offset.y - s * u + c * v};
  }
  return uvs;
}

std::vector<Vec4> Colors(const Floats& values, size_t vertices) {
  const size_t components = values.size() / vertices;
  std::vector<Vec4> colors(vertices, Vec4{1, 1, 1, 1});
  for (size_t i = 0; i < vertices; ++i) {
    float* out = &colors[i].x;
    for (size_t c = 0; c < std::min<size_t>(components, 4); ++c) {
      out[c] = std::clamp(values[i * components + c], 0.0f, 1.0f);
    }
  }
  return colors;
}

// Beyond what any skin has; what is larger is refused with it.
constexpr float kMostJointIndex = 65536;

Influences ReadInfluences(const RawPrimitive& raw, size_t vertices) {
  Influences out;
  int sets = 0;
  while (Find(raw, "JOINTS_" + std::to_string(sets)) != nullptr &&
         Find(raw, "WEIGHTS_" + std::to_string(sets)) != nullptr) {
    ++sets;
  }
  out.per_vertex = 4 * sets;
  out.joints.resize(vertices * 4 * static_cast<size_t>(sets));
  out.weights.resize(out.joints.size());
  for (size_t s = 0; s < static_cast<size_t>(sets); ++s) {
    const Floats& joints = *Find(raw, "JOINTS_" + std::to_string(s));
    const Floats& weights = *Find(raw, "WEIGHTS_" + std::to_string(s));
    for (size_t i = 0; i < vertices * 4; ++i) {
      const size_t to = i / 4 * 4 * static_cast<size_t>(sets) + 4 * s + i % 4;
      out.joints[to] = static_cast<int>(std::clamp(joints[i], -1.0f, kMostJointIndex));
      out.weights[to] = weights[i];
    }
  }
  return out;
}

template <typename T>
void Gather(const std::vector<uint32_t>& from, size_t width, std::vector<T>* values) {
  if (values->empty()) return;
  std::vector<T> out;
  out.reserve(from.size() * width);
  for (const uint32_t i : from) {
    out.insert(out.end(), values->begin() + static_cast<std::ptrdiff_t>(i * width),
               values->begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
  }
  *values = std::move(out);
}

Vec3 FaceNormal(const Mesh& mesh, size_t triangle) {
  const uint32_t* i = &mesh.indices[3 * triangle];
  const Vec3 a = mesh.positions[i[0]];
  const Vec3 n = Cross(mesh.positions[i[1]] - a, mesh.positions[i[2]] - a);
  const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  // Scaled first, so that the tiny squares of tiny triangles don't vanish.
  return largest > 0 ? Normalized(n * (1 / largest)) : Vec3{0, 1, 0};
}

void AddFlatNormals(DocumentPrimitive* out) {
  Mesh& mesh = out->mesh;
  const std::vector<uint32_t> from = mesh.indices;
  Gather(from, 1, &mesh.positions);
  Gather(from, 1, &mesh.uvs);
  Gather(from, 1, &mesh.uvs1);
  Gather(from, 1, &mesh.colors);
  Gather(from, static_cast<size_t>(out->influences.per_vertex), &out->influences.joints);
  Gather(from, static_cast<size_t>(out->influences.per_vertex), &out->influences.weights);
  for (std::vector<Vec3>& offsets : out->face) Gather(from, 1, &offsets);
  mesh.normals.resize(from.size());
  for (size_t i = 0; i < from.size(); ++i) mesh.indices[i] = static_cast<uint32_t>(i);
  for (size_t i = 0; i < from.size(); ++i) mesh.normals[i] = FaceNormal(mesh, i / 3);
}

// Unit length; a zero or non-finite normal becomes that of a triangle at the vertex.
void RepairNormals(Mesh* mesh) {
  std::vector<bool> bad(mesh->normals.size());
  for (size_t i = 0; i < bad.size(); ++i) {
    mesh->normals[i] = Normalized(mesh->normals[i]);
    const float length = Length(mesh->normals[i]);
    bad[i] = !(length > 0.5f && length < 2);
  }
  for (size_t i = 0; i < mesh->indices.size(); ++i) {
    const uint32_t v = mesh->indices[i];
    if (bad[v]) mesh->normals[v] = FaceNormal(*mesh, i / 3);
  }
  for (size_t i = 0; i < bad.size(); ++i) {
    if (bad[i] && !(Length(mesh->normals[i]) > 0.5f)) mesh->normals[i] = {0, 1, 0};
  }
}

Error CheckWidths(const RawPrimitive& raw, size_t vertices) {
  for (const auto& [name, values] : raw.attributes) {
    const size_t width = values.size() / vertices;
    const size_t wanted = name == "NORMAL"               ? 3
                          : name.starts_with("TEXCOORD") ? 2
                          : name.starts_with("COLOR")    ? (width == 3 ? 3 : 4)
                          : name.starts_with("POSITION") ? 3
                          : name.starts_with("FACE")     ? 3
                                                         : 4;
    if (width != wanted || values.size() != width * vertices) {
      return Fail(name + " has not " + std::to_string(wanted) + " numbers a vertex");
    }
  }
  return Ok();
}

}  // namespace

Error MakePrimitive(RawPrimitive raw, const UvSource& uv_source, DocumentPrimitive* out) {
  const Floats* positions = Find(raw, "POSITION");
  if (positions == nullptr || positions->size() < 3) return Ok();
  const size_t vertices = positions->size() / 3;
  if (Error e = CheckLengths(raw, vertices)) return e;
  if (Error e = CheckWidths(raw, vertices)) return e;
  if (Error e = CheckFinite(raw, vertices)) return e;
  Mesh& mesh = out->mesh;
  if (Error e = Triangles(raw, vertices, &mesh.indices)) return e;
  mesh.positions = Packed<Vec3>(*positions);
  const Floats* uvs = Find(raw, "TEXCOORD_" + std::to_string(uv_source.set));
  if (uvs != nullptr) mesh.uvs = Uvs(*uvs, uv_source);
  const Floats* uvs1 = Find(raw, "TEXCOORD_1");
  if (uvs1 != nullptr && uv_source.set == 0) mesh.uvs1 = Packed<Vec2>(*uvs1);
  if (const Floats* colors = Find(raw, "COLOR_0")) mesh.colors = Colors(*colors, vertices);
  out->influences = ReadInfluences(raw, vertices);
  for (size_t move = 0; move < kFaceMoves; ++move) {
    if (const Floats* offsets = Find(raw, "FACE_" + std::to_string(move))) out->face[move] = Packed<Vec3>(*offsets);
  }
  const Floats* normals = Find(raw, "NORMAL");
  if (normals == nullptr) {
    AddFlatNormals(out);
  } else {
    mesh.normals = Packed<Vec3>(*normals);
    RepairNormals(&mesh);
  }
  return Ok();
}

}  // namespace flaneur
