// Words of a name that somebody gave to a node or clip.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace flaneur {

// In lower case, as they come: "hex_grass.001" and "HexGrass" are both hex, grass. Letters beyond ASCII stay as they
// are.
std::vector<std::string> NameWords(std::string_view name);

}  // namespace flaneur
