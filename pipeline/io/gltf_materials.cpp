#include "pipeline/io/gltf_materials.h"

#include <tiny_gltf.h>

#include <algorithm>

#include "pipeline/io/basis_picture.h"
#include "pipeline/io/gltf_accessor.h"
#include "pipeline/io/gltf_names.h"
#include "pipeline/io/gltf_number.h"
#include "pipeline/io/image_beside.h"
#include "pipeline/io/webp_picture.h"
#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/base/png.h"

namespace flaneur {
namespace {

using tinygltf::Model;
using tinygltf::Value;

// Images: those in use are copied once.
class ImageTable {
 public:
  ImageTable(const Model& model, GltfDocument* document)
      : model_(model), document_(document), index_(model.images.size(), -1) {}

  // The document's image behind a texture of the file; -1 where there is none.
  Error Use(int texture, int* image) {
    *image = -1;
    if (texture < 0) return Ok();
    if (static_cast<size_t>(texture) >= model_.textures.size()) {
      return Fail("texture " + std::to_string(texture) + " does not exist");
    }
    const int source = SourceOf(At(model_.textures, texture));
    if (source < 0) return Fail("texture " + std::to_string(texture) + " has no PNG, JPEG, WebP or KTX2 image");
    if (static_cast<size_t>(source) >= model_.images.size()) {
      return Fail("image " + std::to_string(source) + " does not exist");
    }
    int& index = At(index_, source);
    if (index < 0) {
      Image copy;
      if (Error e = Copy(static_cast<size_t>(source), &copy)) return e;
      index = Count(document_->images);
      document_->images.push_back(std::move(copy));
    }
    *image = index;
    return Ok();
  }

 private:
  // PNG or JPEG where the file has another besides.
  static int SourceOf(const tinygltf::Texture& texture) {
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp"}) {
      const auto other = texture.extensions.find(name);
      if (texture.source < 0 && other != texture.extensions.end() && other->second.Has("source"))
        return IndexOf(other->second.Get("source"));
    }
    return texture.source;
  }

  // As PNG, which all that follows reads.
  Error Unpack(Image* image) {
    pixels_left_ += kPixelsAByte * image->bytes.size();
    Pixels pixels;
    if (Error e = IsWebp(image->bytes) ? DecodeWebpPicture(image->bytes, pixels_left_, &pixels)
                                       : DecodeBasisPicture(image->bytes, pixels_left_, &pixels)) {
      return Fail("image " + Quoted(image->name) + " " + e.message);
    }
    pixels_left_ -= pixels.rgba.size() / 4;
    image->mime_type = "image/png";
    image->bytes = EncodePng(pixels.width, pixels.height, 4, pixels.rgba);
    return image->bytes.empty() ? Fail("image " + Quoted(image->name) + ": not enough memory") : Ok();
  }

  Error Copy(size_t source, Image* out) {
    const tinygltf::Image& in = model_.images[source];
    const std::string file = in.uri.starts_with("data:") ? "" : in.uri.substr(0, 200);
    out->name = NameOr(in.name.empty() ? file : in.name, "image", source);
    out->bytes = in.image;
    if (in.bufferView >= 0) {
      std::span<const uint8_t> bytes;
      if (Error e = BufferViewBytes(model_, in.bufferView, &bytes)) return e;
      out->bytes.assign(bytes.begin(), bytes.end());
    }
    if (out->bytes.empty()) return Fail("image " + Quoted(out->name) + " is missing or empty");
    out->mime_type = MimeTypeOf(out->bytes);
    if (!out->mime_type.empty()) return Ok();
    if (IsKtx2(out->bytes) || IsWebp(out->bytes)) return Unpack(out);
    return Fail("image " + Quoted(out->name) + " is neither PNG, JPEG, WebP nor KTX2; convert it");
  }

  const Model& model_;
  GltfDocument* document_;
  std::vector<int> index_;
  uint64_t pixels_left_ = kFreePixels;  // of KTX2 and WebP pictures
};

Vec2 Pair(const Value& object, const char* key, Vec2 otherwise) {
  if (!object.Has(key) || object.Get(key).ArrayLen() != 2) return otherwise;
  const Value& pair = object.Get(key);
  return {static_cast<float>(pair.Get(0).GetNumberAsDouble()), static_cast<float>(pair.Get(1).GetNumberAsDouble())};
}

UvSource ReadUvSource(int set, const tinygltf::ExtensionMap& extensions) {
  UvSource out;
  out.set = set;
  const auto it = extensions.find("KHR_texture_transform");
  if (it == extensions.end() || !it->second.IsObject()) return out;
  const Value& transform = it->second;
  out.offset = Pair(transform, "offset", out.offset);
  out.scale = Pair(transform, "scale", out.scale);
  if (transform.Has("rotation")) {
    out.rotation_rad = static_cast<float>(transform.Get("rotation").GetNumberAsDouble());
  }
  if (transform.Has("texCoord")) out.set = IndexOf(transform.Get("texCoord"));
  return out;
}

Vec4 Factor(const std::vector<double>& values) {
  if (values.size() != 4) return {1, 1, 1, 1};
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]),
          static_cast<float>(values[3])};
}

// The diffuse part of KHR_materials_pbrSpecularGlossiness stands in for the base colour.
void ReadDiffuse(const Value& extension, Vec4* factor, int* texture) {
  if (extension.Has("diffuseFactor")) {
    const Value& diffuse = extension.Get("diffuseFactor");
    std::vector<double> values;
    for (size_t i = 0; i < diffuse.ArrayLen(); ++i) {
      values.push_back(diffuse.Get(static_cast<int>(i)).GetNumberAsDouble());
    }
    *factor = Factor(values);
  }
  if (extension.Has("diffuseTexture") && extension.Get("diffuseTexture").Has("index")) {
    *texture = IndexOf(extension.Get("diffuseTexture").Get("index"));
  }
}

bool SameUvs(const UvSource& a, const UvSource& b) {
  return a.set == b.set && a.rotation_rad == b.rotation_rad && Length(a.offset - b.offset) == 0 &&
         Length(a.scale - b.scale) == 0;
}

Error ReadMaterial(const tinygltf::Material& in, ImageTable* images, Material* out, UvSource* uv_source,
                   std::vector<std::string>* warnings) {
  const auto& pbr = in.pbrMetallicRoughness;
  out->base_color = Factor(pbr.baseColorFactor);
  // Exporters round: 1.0000006 is 1.
  out->metallic = static_cast<float>(std::clamp(pbr.metallicFactor, 0.0, 1.0));
  out->roughness = static_cast<float>(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
  const bool drawn_flat =
      in.extensions.count("KHR_materials_unlit") > 0 || in.extensions.count("VRMC_materials_mtoon") > 0;
  if (drawn_flat) out->metallic = 0, out->roughness = 1;
  out->double_sided = in.doubleSided;
  out->alpha_cutoff = static_cast<float>(in.alphaCutoff);
  if (in.alphaMode == "MASK") out->alpha = Material::Alpha::kMask;
  if (in.alphaMode == "BLEND") out->alpha = Material::Alpha::kBlend;
  int base_texture = pbr.baseColorTexture.index;
  const auto glossiness = in.extensions.find("KHR_materials_pbrSpecularGlossiness");
  if (glossiness != in.extensions.end()) {
    ReadDiffuse(glossiness->second, &out->base_color, &base_texture);
    out->metallic = 0;
  }
  if (Error e = images->Use(base_texture, &out->base_color_image)) return e;
  if (Error e = images->Use(in.normalTexture.index, &out->normal_image)) return e;
  const UvSource normal_uvs = ReadUvSource(in.normalTexture.texCoord, in.normalTexture.extensions);
  *uv_source = out->base_color_image >= 0 ? ReadUvSource(pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions)
                                          : normal_uvs;
  if (out->normal_image >= 0 && !SameUvs(*uv_source, normal_uvs)) {
    out->normal_image = -1;
    warnings->push_back("material " + Quoted(out->name) +
                        ": its normal map is left out, as it lies on other uvs than its colour");
  }
  return Ok();
}

}  // namespace

Error ReadMaterials(const tinygltf::Model& model, GltfDocument* document, std::vector<UvSource>* uv_sources,
                    std::vector<std::string>* warnings) {
  ImageTable images(model, document);
  document->materials.resize(model.materials.size());
  uv_sources->resize(model.materials.size());
  for (size_t i = 0; i < model.materials.size(); ++i) {
    Material& material = document->materials[i];
    material.name = NameOr(model.materials[i].name, "material", i);
    if (Error e = ReadMaterial(model.materials[i], &images, &material, &(*uv_sources)[i], warnings)) {
      return Fail("material " + Quoted(material.name) + ": " + e.message);
    }
  }
  return Ok();
}

}  // namespace flaneur
