// What a person's file holds, in words.
#pragma once
#include <filesystem>
#include <string>

#include "runtime/base/error.h"

namespace flaneur {

// Lines of text: the nodes that show something, with triangles, size and the bone each hangs on; the clips with their
// lengths; the bones that stand for parts of a human body, or why none do; what the file says of up, facing and size.
// Errors: as for ReadGltfScene and OpenMotion.
Error DescribePersonFile(const std::filesystem::path& path, std::string* text);

}  // namespace flaneur
