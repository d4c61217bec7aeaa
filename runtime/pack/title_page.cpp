#include "runtime/pack/title_page.h"

#include <array>
#include <cstring>
#include <fstream>

#include "runtime/base/file.h"
#include "runtime/base/json_text.h"
#include "runtime/base/limits.h"
#include "runtime/base/text.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

constexpr size_t kHead = 20, kChunkHead = 8;      // bytes: of the file with its first chunk, of the next
constexpr uint64_t kMostFile = 32 * 1024 * 1024;  // of a picture, in bytes
constexpr uint64_t kMostDescription = 256 * 1024 * 1024;

// A pack of which only some has been read.
struct Parts {
  std::ifstream file;
  uint64_t bytes = 0, binary_at = 0;
  Json json;
};

bool ReadAt(uint64_t at, uint64_t count, std::ifstream* file, char* out) {
  file->seekg(static_cast<std::streamoff>(at));
  file->read(out, static_cast<std::streamsize>(count));
  return static_cast<uint64_t>(file->gcount()) == count;
}

bool Open(const std::filesystem::path& path, Parts* parts) {
  std::error_code ec;
  if (CheckReadable(path)) return false;
  parts->bytes = std::filesystem::file_size(path, ec);
  parts->file.open(path, std::ios::binary);
  std::array<char, kHead> head{};
  if (ec || !parts->file || !ReadAt(0, kHead, &parts->file, head.data())) return false;
  uint32_t words[5];
  std::memcpy(words, head.data(), sizeof words);
  constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A;
  if (words[0] != kMagic || words[1] != 2 || words[4] != kJsonChunk) return false;
  if (words[3] > kMostDescription || kHead + words[3] > parts->bytes) return false;
  std::string text(words[3], ' ');
  if (!ReadAt(kHead, text.size(), &parts->file, text.data())) return false;
  if (NestsTooDeep(text) || MemoryOfJson_bytes(text) > kPackMemory_bytes) return false;
  parts->json = Json::parse(text, nullptr, false);
  parts->binary_at = kHead + text.size() + kChunkHead;
  return parts->json.is_object();
}

// Of a buffer view that lies in the file as it is.
std::vector<uint8_t> ReadView(const TourObject& page, const char* key, Parts* parts) {
  if (!page.Has(key)) return {};
  const int index = page.View(key, Member(parts->json, "bufferViews").size());
  const TourObject view(Element(parts->json, "bufferViews", index), "bufferViews");
  constexpr double kMost = 4294967295.0;
  const auto whole = [&](const char* member, double otherwise) {
    double value = otherwise;
    view.Number(member, &value, 0, kMost);
    return static_cast<uint64_t>(value);
  };
  const uint64_t from = parts->binary_at + whole("byteOffset", 0), bytes = whole("byteLength", 0);
  if (whole("buffer", 0) != 0 || bytes > kMostFile || from + bytes > parts->bytes)
    page.Refuse(std::string(key) + " lies beyond the file's end, or is too large");
  std::vector<uint8_t> read(bytes);
  if (!ReadAt(from, bytes, &parts->file, reinterpret_cast<char*>(read.data()))) page.Refuse("cannot be read");
  return read;
}

std::string TitleIn(const std::string& language, const TourObject& tour) {
  const std::string own = tour.Has("language") ? tour.Text("language") : "en";
  if (tour.Has("titles")) {
    const TourObject titles = tour.Object("titles");
    for (const std::string& wished : {language, own}) {
      if (titles.Has(wished.c_str())) return titles.Text(wished.c_str());
    }
  }
  return tour.Text("name");
}

}  // namespace

bool ReadPackTitle(const std::filesystem::path& path, const std::string& language, PackTitle* title) {
  try {
    Parts parts;
    if (!Open(path, &parts)) return false;
    const TourObject tour(Member(Member(parts.json, "extensions"), kTourExtension), kTourExtension);
    PackTitle read;
    read.title = TitleIn(language, tour);
    *title = read;
    if (!tour.Has("title_page")) return true;
    const TourObject page = tour.Object("title_page");
    read.page.background = page.Color("background");
    read.page.picture = ReadView(page, "picture_view", &parts);
    read.page.logo = ReadView(page, "logo_view", &parts);
    *title = std::move(read);
    return true;
  } catch (const std::exception&) {
    return !title->title.empty();
  }
}

}  // namespace flaneur
