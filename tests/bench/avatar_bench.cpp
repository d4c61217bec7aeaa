// Decimates people with other libraries, and measures levels of detail of any origin against the
// original. avatar_levels.py calls it.
#include <meshoptimizer.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
// Needs the above first.
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>

#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/surface_places.h"
#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/gltf_document.h"
#include "pipeline/io/gltf_pose.h"

namespace flaneur {
namespace {

constexpr int kPoses = 8;  // of the walk, besides the bind pose

struct Person {
  GltfDocument document;
  std::vector<std::string> joint_names;
  std::vector<Mesh> meshes;
};

void FillWeights(const Influences& in, Mesh* mesh) {
  const auto width = static_cast<size_t>(in.per_vertex);
  for (size_t v = 0; v < mesh->positions.size(); ++v) {
    std::array<uint16_t, 4> joints{};
    std::array<float, 4> weights{};
    float sum = 0;
    for (size_t i = 0; i < std::min<size_t>(width, 4); ++i) {
      joints[i] = static_cast<uint16_t>(in.joints[v * width + i]);
      weights[i] = in.weights[v * width + i];
      sum += weights[i];
    }
    for (float& weight : weights) weight = sum > 0 ? weight / sum : 0;
    mesh->joints.push_back(joints);
    mesh->weights.push_back(weights);
  }
}

// A file with one skin; vertices are taken as they stand, in the space the skin is bound in.
Error LoadPerson(const std::string& path, Person* person) {
  std::vector<std::string> warnings;
  if (Error e = LoadGltf(path, &person->document, &warnings)) return e;
  const GltfDocument& document = person->document;
  if (document.skins.empty()) return Fail(path + ": no skin");
  for (const int joint : document.skins[0].joints) {
    person->joint_names.push_back(document.nodes[static_cast<size_t>(joint)].name);
  }
  for (const DocumentMesh& mesh : document.meshes) {
    for (const DocumentPrimitive& primitive : mesh.primitives) {
      person->meshes.push_back(primitive.mesh);
      FillWeights(primitive.influences, &person->meshes.back());
    }
  }
  return Ok();
}

// The walk's poses of the skin's joints; the first is the bind pose.
std::vector<std::vector<Mat4>> Poses(const Person& person) {
  const GltfDocument& document = person.document;
  const DocumentSkin& skin = document.skins[0];
  std::vector<std::vector<Mat4>> poses{std::vector<Mat4>(skin.joints.size())};
  for (const DocumentClip& clip : document.clips) {
    if (clip.name != "walk") continue;
    const ClipSpan span = SpanOf(clip);
    for (int i = 0; i < kPoses; ++i) {
      const float share = static_cast<float>(i) / kPoses;
      const std::vector<Mat4> world = PoseAt(document, clip, span.start_s + share * (span.end_s - span.start_s));
      auto& pose = poses.emplace_back();
      for (size_t j = 0; j < skin.joints.size(); ++j) {
        pose.push_back(world[static_cast<size_t>(skin.joints[j])] * skin.inverse_binds[j]);
      }
    }
  }
  return poses;
}

// The level's joints as the original's, by name.
Error MapJoints(const Person& original, Person* level) {
  std::map<std::string, uint16_t> index;
  for (const std::string& name : original.joint_names) index.try_emplace(name, index.size());
  for (Mesh& mesh : level->meshes) {
    for (size_t v = 0; v < mesh.joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        if (!(mesh.weights[v][i] > 0)) continue;
        const auto found = index.find(level->joint_names[mesh.joints[v][i]]);
        if (found == index.end()) return Fail("a joint of the level is not in the original");
        mesh.joints[v][i] = found->second;
      }
    }
  }
  return Ok();
}

std::vector<Vec3> Sampled(const Triangles& triangles, int count) {
  std::vector<double> sums;
  double total = 0;
  for (const auto& t : triangles) {
    total += static_cast<double>(Length(Cross(t[1] - t[0], t[2] - t[0])));
    sums.push_back(total);
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const auto at = std::upper_bound(sums.begin(), sums.end(), unit(random) * total);
    const auto& t = triangles[std::min<size_t>(static_cast<size_t>(at - sums.begin()), triangles.size() - 1)];
    const auto root = static_cast<float>(std::sqrt(unit(random)));
    const float b = root * static_cast<float>(unit(random));
    points.push_back(t[0] * (1 - root) + t[1] * (root - b) + t[2] * b);
  }
  return points;
}

struct Distances {
  double mean_mm = 0, greatest_mm = 0;
};

// Of both directions: the mean of the means, the greatest of all.
Distances Between(const Triangles& a, const Triangles& b, int samples) {
  Distances out;
  for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    const SurfaceTree tree(*to);
    double sum = 0;
    for (const Vec3 p : Sampled(*from, samples)) {
      const double mm = 1000 * static_cast<double>(tree.Distance(p));
      sum += mm;
      out.greatest_mm = std::max(out.greatest_mm, mm);
    }
    out.mean_mm += sum / samples / 2;
  }
  return out;
}

nlohmann::json Measured(const Person& original, const std::vector<std::vector<Mat4>>& poses, const Person& level,
                        int samples) {
  std::vector<Distances> all(poses.size());
  const auto measure = [&](size_t first, size_t step) {
    for (size_t k = first; k < poses.size(); k += step) {
      all[k] = Between(PosedTriangles(original.meshes, &poses[k]), PosedTriangles(level.meshes, &poses[k]), samples);
    }
  };
  const size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::thread> workers;
  for (size_t i = 0; i < threads; ++i) workers.emplace_back(measure, i, threads);
  for (std::thread& worker : workers) worker.join();
  Distances posed;
  for (size_t k = 1; k < all.size(); ++k) {
    posed.mean_mm += all[k].mean_mm / static_cast<double>(all.size() - 1);
    posed.greatest_mm = std::max(posed.greatest_mm, all[k].greatest_mm);
  }
  int triangles = 0;
  for (const Mesh& mesh : level.meshes) triangles += TriangleCount(mesh);
  return {{"triangles", triangles},
          {"mean_mm", all[0].mean_mm},
          {"greatest_mm", all[0].greatest_mm},
          {"posed_mean_mm", posed.mean_mm},
          {"posed_greatest_mm", posed.greatest_mm}};
}

Error Measure(const std::vector<std::string>& args) {
  if (args.size() < 3) return Fail("measure ORIGINAL SAMPLES LEVEL...");
  Person original;
  if (Error e = LoadPerson(args[0], &original)) return e;
  const auto poses = Poses(original);
  nlohmann::json list = nlohmann::json::array();
  for (size_t i = 2; i < args.size(); ++i) {
    Person level;
    if (Error e = LoadPerson(args[i], &level)) return e;
    if (Error e = MapJoints(original, &level)) return Fail(args[i] + ": " + e.message);
    if (level.meshes.empty()) return Fail(args[i] + ": nothing is left of the person");
    list.push_back(Measured(original, poses, level, std::atoi(args[1].c_str())));
  }
  std::printf("%s\n", list.dump().c_str());
  return Ok();
}

// By name, the clip's pose of the person's joints at a time.
std::vector<Mat4> PoseByName(const Person& person, const Person& names, const DocumentClip& clip, float time_s) {
  const std::vector<Mat4> world = PoseAt(person.document, clip, time_s);
  std::map<std::string, size_t> node;
  for (size_t i = 0; i < world.size(); ++i) node.try_emplace(person.document.nodes[i].name, i);
  std::vector<Mat4> pose;
  for (size_t j = 0; j < names.joint_names.size(); ++j) {
    const auto found = node.find(names.joint_names[j]);
    const Mat4 joint = found == node.end() ? Mat4{} : world[found->second];
    pose.push_back(joint * names.document.skins[0].inverse_binds[j]);
  }
  return pose;
}

// How far the original's vertices are from where they should be, over all clips at 60 Hz.
Error MeasureClips(const std::vector<std::string>& args) {
  if (args.size() != 2) return Fail("clips ORIGINAL FILE");
  Person original, other;
  if (Error e = LoadPerson(args[0], &original)) return e;
  if (Error e = LoadPerson(args[1], &other)) return e;
  double sum = 0, count = 0, greatest = 0;
  for (const DocumentClip& clip : original.document.clips) {
    const auto& clips = other.document.clips;
    const auto found = std::find_if(clips.begin(), clips.end(), [&](const auto& c) { return c.name == clip.name; });
    if (found == clips.end()) return Fail(args[1] + ": no clip '" + clip.name + "'");
    const float duration_s = SpanOf(clip).end_s;
    const int steps = static_cast<int>(duration_s * 60);
    for (int i = 0; i <= steps; ++i) {
      const float time_s = duration_s * static_cast<float>(i) / static_cast<float>(steps);
      const auto wanted = PoseByName(original, original, clip, time_s);
      const auto is = PoseByName(other, original, *found, time_s);
      for (const Mesh& mesh : original.meshes) {
        const auto a = SkinnedPositions(mesh, wanted), b = SkinnedPositions(mesh, is);
        for (size_t v = 0; v < a.size(); ++v) {
          const double mm = 1000 * static_cast<double>(Length(a[v] - b[v]));
          sum += mm, count += 1, greatest = std::max(greatest, mm);
        }
      }
    }
  }
  std::printf("{\"mean_mm\": %.4f, \"greatest_mm\": %.4f}\n", sum / std::max(count, 1.0), greatest);
  return Ok();
}

// Vertices joined by position; corner attributes left behind.
Mesh Welded(const std::vector<Mesh>& meshes) {
  const WedgeSurface surface = JoinWedges(meshes);
  Mesh out;
  for (const auto& vertex : surface.vertices) {
    out.positions.push_back(vertex.position);
    out.joints.push_back(vertex.joints);
    out.weights.push_back(vertex.weights);
  }
  for (const auto& face : surface.faces) {
    for (const int v : face.vertices) out.indices.push_back(static_cast<uint32_t>(v));
  }
  return out;
}

void DecimateWithMeshoptimizer(size_t triangles, Mesh* mesh) {
  std::vector<uint32_t> indices(mesh->indices.size());
  indices.resize(meshopt_simplify(indices.data(), mesh->indices.data(), mesh->indices.size(), &mesh->positions[0].x,
                                  mesh->positions.size(), sizeof(Vec3), 3 * triangles, 1.0f));
  mesh->indices = indices;
}

void DecimateWithOpenMesh(size_t triangles, Mesh* mesh) {
  using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<>;
  HalfEdgeMesh half_edges;
  for (const Vec3 p : mesh->positions) half_edges.add_vertex({p.x, p.y, p.z});
  omerr().disable();
  for (size_t i = 0; i < mesh->indices.size(); i += 3) {
    half_edges.add_face(half_edges.vertex_handle(mesh->indices[i]), half_edges.vertex_handle(mesh->indices[i + 1]),
                        half_edges.vertex_handle(mesh->indices[i + 2]));
  }
  omerr().enable();
  OpenMesh::Decimater::DecimaterT<HalfEdgeMesh> decimater(half_edges);
  OpenMesh::Decimater::ModQuadricT<HalfEdgeMesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  decimater.decimate_to_faces(0, triangles);
  mesh->indices.clear();
  for (const auto face : half_edges.faces()) {
    for (const auto vertex : half_edges.fv_range(face)) {
      mesh->indices.push_back(static_cast<uint32_t>(vertex.idx()));
    }
  }
}

Error Decimate(const std::vector<std::string>& args) {
  if (args.size() != 4) return Fail("decimate openmesh|meshoptimizer IN RATIO OUT");
  Person person;
  if (Error e = LoadPerson(args[1], &person)) return e;
  const auto start = std::chrono::steady_clock::now();
  int original = 0;
  for (const Mesh& mesh : person.meshes) original += TriangleCount(mesh);
  const auto target = static_cast<size_t>(std::lround(std::atof(args[2].c_str()) * original));
  AvatarLevels levels;
  levels.levels.emplace_back();
  Mesh mesh = Welded(person.meshes);
  if (args[0] == "openmesh") DecimateWithOpenMesh(target, &mesh);
  if (args[0] == "meshoptimizer") DecimateWithMeshoptimizer(target, &mesh);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  levels.levels[0].meshes = {mesh};
  const auto& binds = person.document.skins[0].inverse_binds;
  for (size_t j = 0; j < person.joint_names.size(); ++j) {
    levels.avatar.joints.push_back({person.joint_names[j], -1, {}, binds[j]});
  }
  DracoOptions draco;
  draco.compress = false;
  std::printf("{\"seconds\": %.4f}\n", seconds.count());
  return WriteAvatarGlb(args[3], levels, draco);
}

Error Run(std::vector<std::string> args) {
  const std::string command = args.empty() ? "" : args[0];
  if (!args.empty()) args.erase(args.begin());
  if (command == "measure") return Measure(args);
  if (command == "clips") return MeasureClips(args);
  if (command == "decimate") return Decimate(args);
  return Fail("a command is needed: measure, clips or decimate");
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  const flaneur::Error error = flaneur::Run({argv + 1, argv + argc});
  if (error) std::fprintf(stderr, "avatar_bench: error: %s\n", error.message.c_str());
  return error ? 2 : 0;
}
