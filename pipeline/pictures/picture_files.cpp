#include "pipeline/pictures/picture_files.h"

#include <dlfcn.h>

#include "pipeline/pictures/module/picture_module.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

struct Loaded {
  const PictureModule* module = nullptr;
  Error error;
};

// FLANEUR_PICTURE_MODULE: from the folder of the programs, as they are built and installed.
Loaded Load() {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const fs::path file = (own.parent_path() / FLANEUR_PICTURE_MODULE).lexically_normal();
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = library ? dlsym(library, kPictureModuleFunction) : nullptr;
  if (!function) {
    const char* why = dlerror();
    return {nullptr, Fail("pictures need " + file.string() +
                          ", which belongs to flaneur; install it again: " + OneLine(why ? why : ""))};
  }
  return {reinterpret_cast<decltype(&FlaneurPictureModule)>(function)(), Ok()};
}

Error Module(const PictureModule** module) {
  static const Loaded loaded = Load();
  *module = loaded.module;
  return loaded.error;
}

template <typename Values, typename Function>
Error Read(const fs::path& file, const AcceptPicture& accept, Values values, Function PictureModule::*read) {
  const PictureModule* module = nullptr;
  if (Error e = Module(&module)) return e;
  Error refused;
  const std::string why = (module->*read)(file.string(), accept, values, &refused);
  if (refused) return refused;
  return why.empty() ? Ok() : Fail(file.string() + ": " + OneLine(why));
}

}  // namespace

Error ReadPicture(const fs::path& file, const AcceptPicture& accept, const TakeRows& take) {
  return Read<const TakeRows&>(file, accept, take, &PictureModule::read_floats);
}

Error ReadPicture(const fs::path& file, const AcceptPicture& accept, std::vector<uint8_t>* values) {
  return Read(file, accept, values, &PictureModule::read_bytes);
}

std::string PictureVersion() { return "OpenImageIO " FLANEUR_OPENIMAGEIO_VERSION; }

Error EncodePng(const Pixels& pixels, bool srgb, Image* image) {
  const PictureModule* module = nullptr;
  if (Error e = Module(&module)) return e;
  image->mime_type = "image/png";
  const std::string why = module->encode_png(pixels, srgb, &image->bytes);
  return why.empty() ? Ok() : Fail("OpenImageIO cannot write PNG: " + OneLine(why));
}

Error ScaledPicture(const fs::path& file, int most_px, std::vector<uint8_t>* bytes) {
  const PictureModule* module = nullptr;
  if (Error e = Module(&module)) return e;
  const std::string why = module->scaled(file.string(), most_px, bytes);
  return why.empty() ? Ok() : Fail(file.string() + ": no picture that can be read: " + OneLine(why));
}

}  // namespace flaneur
