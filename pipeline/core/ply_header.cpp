#include "pipeline/core/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "pipeline/core/obj_files.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

bool ReadType(std::string_view word, PlyType* type) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},
      {"float32", PlyType::kFloat},
      {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble},
  }};
  const auto* known = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == word; });
  if (known == kTypes.end()) return false;
  *type = known->second;
  return true;
}

Error ReadFormat(std::string_view word, PlyFormat* format) {
  if (word == "ascii") *format = PlyFormat::kAscii;
  else if (word == "binary_little_endian") *format = PlyFormat::kLittleEndian;
  else if (word == "binary_big_endian") *format = PlyFormat::kBigEndian;
  else return Fail("'" + std::string(word.substr(0, 30)) + "' is no PLY format");
  return Ok();
}

Error ReadElement(std::string_view rest, PlyHeader* header) {
  PlyElement element;
  element.name = NextWord(&rest);
  if (!ReadNumber(NextWord(&rest), &element.count)) return Fail("an element needs a name and how many there are");
  header->elements.push_back(std::move(element));
  return Ok();
}

Error ReadProperty(std::string_view rest, PlyHeader* header) {
  PlyProperty property;
  std::string_view word = NextWord(&rest);
  property.is_list = word == "list";
  if (property.is_list) {
    word = NextWord(&rest);
    const bool whole = ReadType(word, &property.count_type) && property.count_type != PlyType::kFloat &&
                       property.count_type != PlyType::kDouble;
    if (!whole) return Fail("'" + std::string(word.substr(0, 30)) + "' is no type that counts");
    word = NextWord(&rest);
  }
  if (!ReadType(word, &property.type)) return Fail("'" + std::string(word.substr(0, 30)) + "' is no type of PLY");
  property.name = NextWord(&rest);
  if (header->elements.empty()) return Fail("a property before the first element");
  header->elements.back().properties.push_back(std::move(property));
  return Ok();
}

Error ReadLine(std::string_view line, PlyHeader* header) {
  const std::string_view key = NextWord(&line);
  if (key == "format") return ReadFormat(NextWord(&line), &header->format);
  if (key == "element") return ReadElement(line, header);
  if (key == "property") return ReadProperty(line, header);
  if (key == "comment" && NextWord(&line) == "TextureFile") header->pictures.emplace_back(Trimmed(line));
  return Ok();
}

}  // namespace

bool IsPly(std::string_view beginning) {
  return beginning.substr(0, 3) == "ply" && beginning.size() > 3 && (beginning[3] == '\n' || beginning[3] == '\r');
}

Error ReadPlyHeader(std::string_view bytes, PlyHeader* header) {
  if (!IsPly(bytes)) return Fail("not a PLY file: its first line is not 'ply'");
  *header = {};
  size_t at = 0;
  for (int number = 1; at < bytes.size(); ++number) {
    const size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) break;
    const std::string_view line = Trimmed(bytes.substr(at, end - at));
    at = end + 1;
    if (line == "end_header") {
      header->size_bytes = at;
      return Ok();
    }
    if (Error e = ReadLine(line, header)) return Fail(OneLine("line " + std::to_string(number) + ": " + e.message));
  }
  return Fail("the PLY header has no end");
}

}  // namespace flaneur
