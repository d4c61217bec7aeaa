// Fingerprints of all that each stage of a bake depends on, so that a change makes its dependents anew and nothing
// else.
#pragma once
#include <filesystem>
#include <string>

#include "pipeline/cli/tour_settings.h"

namespace flaneur {

// Of a Blender script: all scripts of its folder, the ones that scripts share, its seed and options.
std::string ScriptInputs(const SourceSettings& source);
// `file` is where the source's glTF is.
std::string AvatarInputs(const AvatarSettings& avatar, const std::filesystem::path& file, const LevelsOptions& levels);
std::string ImpostorInputs(const AvatarSettings& avatar, const std::filesystem::path& file, int max_triangles,
                           const ImpostorOptions& impostor);
// `town` is where the town's glTF is; may be empty.
std::string FootprintsInputs(const TourSettings& settings, const std::filesystem::path& town);
std::string CheckInputs(const TourSettings& settings, const std::string& footprints_inputs);
// Of all of a tour: its settings, files, scripts and this program.
std::string TourInputs(const std::filesystem::path& tour, const TourSettings& settings);

// What an avatar names besides its own file: clips and parts.
std::vector<std::filesystem::path> FilesBeside(const AvatarSettings& avatar);

bool IsScript(const std::filesystem::path& file);

}  // namespace flaneur
