// The impostor stage with its cache: a folder with the atlas and the fingerprint of what it was made from. Internal to
// pipeline/cli.
#pragma once
#include <filesystem>
#include <string>

#include "pipeline/impostor/bake_impostor.h"

namespace flaneur {

// Reads what WriteImpostor wrote, where `folder` holds one with this fingerprint; else false.
bool ReadCachedImpostor(const std::filesystem::path& folder, const std::string& fingerprint, ImpostorAtlas* atlas);
Error WriteCachedImpostor(const std::filesystem::path& folder, const std::string& fingerprint, const ImpostorAtlas& atlas);

}  // namespace flaneur
