// The looks of a Wavefront OBJ: what its material libraries say of colours and pictures.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/io/polygon_soup.h"

namespace flaneur {

class ObjMaterials {
 public:
  // Reads what a line "mtllib" names. A library or picture that is not there, or no PNG, JPEG or WebP, leaves surfaces
  // plain: one warning of each kind.
  void AddLibraries(const std::filesystem::path& obj, std::string_view named);
  // Of the material of that name, given to the builder when first asked for; plain where no library has it.
  FaceLook Use(const std::string& name, TownBuilder* builder);
  void Warn(const std::filesystem::path& obj, std::vector<std::string>* warnings) const;

 private:
  struct Entry {
    Material material;
    std::filesystem::path picture;  // empty: a colour
    FaceLook look;
    bool used = false;
  };
  void AddLibrary(const std::filesystem::path& library);
  std::map<std::string, Entry> entries_;
  std::map<std::filesystem::path, int> of_picture_;  // the builder's images
  std::vector<std::string> lost_libraries_, lost_pictures_;
};

}  // namespace flaneur
