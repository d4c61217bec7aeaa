// Fingerprints of all that each stage of a bake depends on, so that a change makes its dependents anew and nothing
// else.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/cli/tour_settings.h"

namespace flaneur {

// `blender` and `content` below are checksums: of the program, and of the file that a person is read from.

// Of a Blender script: all scripts of its folder, the ones that scripts share, its seed and options.
std::string ScriptInputs(const SourceSettings& source, const std::string& blender);
// `contents`: of the town's file, where it has one, and of its parts'.
std::string TownShapeInputs(const TourSettings& settings, const std::vector<std::string>& contents);
std::string TownInputs(const TourSettings& settings, const std::string& shape_inputs);
std::string TownMeshesInputs(const std::string& shape_inputs);
std::string AvatarInputs(const AvatarSettings& avatar, const std::string& content, const LevelsOptions& levels);
std::string ImpostorInputs(const AvatarSettings& avatar, const std::string& content, const std::string& blender,
                           int max_triangles, const ImpostorOptions& impostor);
std::string TintInputs(const AvatarSettings& avatar, const std::string& avatar_inputs,
                       const std::string& impostor_inputs);
std::string FootprintsInputs(const TourSettings& settings, const std::string& shape_inputs);
std::string CheckInputs(const TourSettings& settings, const std::string& footprints_inputs);
// `needs`: the keys of the steps that the models, or the pack, are made from.
std::string ModelsInputs(const TourSettings& settings, const std::vector<std::string>& needs);
std::string PackInputs(const std::filesystem::path& tour, const TourSettings& settings,
                       const std::vector<std::string>& needs);

// Sounds, pictures and the painting.
std::vector<std::filesystem::path> MediaFiles(const TourSettings& settings);

// What an avatar names besides its own file: clips and parts.
std::vector<std::filesystem::path> FilesBeside(const AvatarSettings& avatar);

bool IsScript(const std::filesystem::path& file);

}  // namespace flaneur
