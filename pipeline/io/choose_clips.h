// Which clip of which file becomes a person's walk, idle, talk and all else they do.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/io/gltf.h"
#include "pipeline/io/gltf_document.h"
#include "pipeline/io/motion_reader.h"

namespace flaneur {

struct ChosenClip {
  std::string name;  // ours
  int file = -1;     // of ClipChoice::files; -1: the avatar's own
  size_t index = 0;  // of the file's clips
};

struct ClipChoice {
  std::vector<ChosenClip> clips;
  std::vector<MotionFile> files;
  int shipped = -1;           // of files: those that come with the program, where any is needed
  bool lone_walk = false;     // the one clip of its file, though no name calls it a walk
  bool shipped_walk = false;  // for want of another
  bool shipped_idle = false;  // the same; then `talk` too
  std::string missing;        // what the avatar's own file has instead of a walk
};

// What a clip becomes that is the only one of its file, and is not named as a walk.
enum class LoneClip : uint8_t { kWalk, kIdle, kNone };

// As ReadAvatarOptions says. A clip that moves nothing is none. Errors: a clip that is named and nowhere, a file that
// cannot be read.
Error ChooseClips(const GltfDocument& document, const ReadAvatarOptions& options, LoneClip lone, ClipChoice* choice);

// What to tell of files that were given for their clips, and none was taken.
std::vector<std::string> UnusedFiles(const ReadAvatarOptions& options, const ClipChoice& choice);

// Whether a clip's name says that something else is done than walking: standing, talking, dancing, a pose.
bool IsNoWalk(const std::string& name);

}  // namespace flaneur
