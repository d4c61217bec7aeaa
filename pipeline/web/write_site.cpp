#include "pipeline/web/write_site.h"

#include <fcntl.h>
#include <stdio.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/web/compress.h"
#include "pipeline/web/html_text.h"
#include "pipeline/web/jpeg.h"
#include "runtime/base/file.h"
#include "runtime/base/pixels.h"
#include "runtime/pack/title_page.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kList = "tour.json";
constexpr const char* kGenerator = "flaneur web";
constexpr const char* kWorker = "worker.js";
constexpr const char* kMainFiles[] = {"page.js", "page.css", kWorker};  // without which there is no page
constexpr const char* kElement = "flaneur-tour";  // other pages' script; its name says the version, which they keep

fs::path PlayerFolder(const SiteOptions& options) {
  if (!options.player.empty()) return options.player;
  std::error_code ec;
  const fs::path installed = fs::read_symlink("/proc/self/exe", ec).parent_path().parent_path() / "share/flaneur/web";
  return fs::is_directory(installed, ec) ? installed : fs::path(FLANEUR_PAGE_FOLDER);
}

Error CheckPlayer(const fs::path& folder) {
  std::vector<std::string> files{"player.js", "player.wasm", "index.html.in", std::string(kElement) + ".js"};
  files.insert(files.end(), std::begin(kMainFiles), std::end(kMainFiles));
  std::error_code ec;
  for (const std::string& file : files) {
    if (!fs::is_regular_file(folder / file, ec))
      return Fail((folder / file).string() + ": the page's player is not there; build it with 'cmake --build FOLDER " +
                  "--target page' (Debian packages emscripten, nodejs), or name another folder with --player");
  }
  return Ok();
}

// What the page asks for by its name: all scripts and looks but the player's and the element's.
std::vector<std::string> PageFiles(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code ec;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ec)) {
    const std::string name = entry.path().filename().string();
    const bool of_page = name.ends_with(".js") || name.ends_with(".css");
    if (of_page && name != "player.js" && name != std::string(kElement) + ".js") files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Nothing of anybody else's is ever replaced.
Error CheckFolder(const fs::path& folder) {
  std::error_code ec;
  const auto status = fs::status(folder, ec);
  if (!fs::exists(status)) return Ok();
  if (!fs::is_directory(status)) return Fail(folder.string() + ": is a file, not a folder");
  if (fs::is_empty(folder, ec)) return Ok();
  std::string text;
  if (!ReadTextFile(folder / kList, &text)) {
    const Json list = Json::parse(text, nullptr, false);
    if (list.is_object() && list.value("generator", "") == kGenerator) return Ok();
  }
  return Fail(folder.string() + ": holds files that flaneur web has not written; name a new or empty folder");
}

void Replace(std::string_view mark, const std::string& by, std::string* text) {
  for (size_t at = text->find(mark); at != std::string::npos; at = text->find(mark, at + by.size()))
    text->replace(at, mark.size(), by);
}

// Files by their names in the site.
class Site {
 public:
  explicit Site(fs::path folder) : folder_(std::move(folder)) {}

  Error Write(const std::string& name, std::span<const uint8_t> bytes) { return WriteFile(folder_ / name, bytes); }
  // And beside it what servers may send in its place.
  Error WriteText(const std::string& name, const std::string& text) {
    const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
    Bytes packed;
    if (Error e = Write(name, bytes)) return e;
    if (Error e = Gzip(bytes, &packed)) return e;
    if (Error e = Write(name + ".gz", packed)) return e;
    text_bytes_ += packed.size();
    if (Error e = Brotli(bytes, &packed)) return e;
    return Write(name + ".br", packed);
  }
  // Compressed, under a name that says what is in it.
  Error WritePacked(std::span<const uint8_t> bytes, std::string* name, size_t* packed_bytes) {
    Bytes packed;
    if (Error e = Gzip(bytes, &packed)) return e;
    const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    *name = "pieces/" + Fingerprint().Add(content).Hex() + ".bin";
    *packed_bytes = packed.size();
    return Write(*name, packed);
  }
  size_t text_bytes() const { return text_bytes_; }

 private:
  fs::path folder_;
  size_t text_bytes_ = 0;  // compressed
};

std::string PosterName(const std::vector<uint8_t>& picture) {
  return picture.size() > 1 && picture[0] == 0xFF ? "poster.jpg" : "poster.png";
}

// Smaller, where that is.
Bytes PosterOf(const PackTitle& title) {
  constexpr int kQuality = 50;
  const auto pixels = Decoded(title.page.picture);
  Bytes smaller = pixels ? EncodeJpeg(*pixels, kQuality) : Bytes();
  return smaller.empty() || smaller.size() > title.page.picture.size() ? title.page.picture : smaller;
}

Error WritePage(const SiteOptions& options, const fs::path& player, const std::string& language, Site* site,
                SiteResult* result) {
  PackTitle title;
  ReadPackTitle(options.pack, language, &title);
  const Bytes picture = PosterOf(title);
  result->first_bytes += picture.size();
  result->all_bytes += picture.size();
  std::string poster = "<div id=\"poster\"></div>";
  if (!picture.empty()) {
    poster = "<img id=\"poster\" src=\"" + PosterName(picture) + "\" alt=\"\">";
    if (Error e = site->Write(PosterName(picture), picture)) return e;
  }
  std::string html;
  if (Error e = ReadTextFile(player / "index.html.in", &html)) return e;
  Replace("@POSTER@", poster, &html);
  Replace("@LANGUAGE@", Escaped(language), &html);
  Replace("@TITLE@", Escaped(title.title), &html);
  const std::vector<std::string> files = PageFiles(player);
  std::string preloads;  // all scripts at once, rather than each when another names it
  for (const std::string& name : files) {
    if (name.ends_with(".js") && !name.ends_with(kWorker))
      preloads += "<link rel=\"modulepreload\" href=\"" + name + "\">\n";
  }
  Replace("@PRELOADS@\n", preloads, &html);
  if (Error e = site->WriteText("index.html", html)) return e;
  std::string kept;  // for a visit without a network
  for (const std::string& name : files) kept += name == kWorker ? "" : ", '" + name + "'";
  for (const std::string& name : files) {
    std::string text;
    if (Error e = ReadTextFile(player / name, &text)) return e;
    if (name == kWorker) Replace(", '@FILES@'", kept, &text);
    if (Error e = site->WriteText(name, text)) return e;
  }
  std::string element;
  result->title = title.title;
  result->language = language;
  result->element_script = std::string(kElement) + "-" FLANEUR_VERSION ".js";
  if (Error e = ReadTextFile(player / (std::string(kElement) + ".js"), &element)) return e;
  return site->WriteText(result->element_script, element);
}

Error WritePlayer(const fs::path& player, Site* site, Json* list, SiteResult* result) {
  Bytes binary;
  std::string script, name;
  size_t bytes = 0;
  if (Error e = ReadFile(player / "player.wasm", &binary)) return e;
  if (Error e = ReadTextFile(player / "player.js", &script)) return e;
  if (Error e = site->WritePacked(binary, &name, &bytes)) return e;
  (*list)["player"] = name;
  (*list)["script"] = "player-" + Fingerprint().Add(script).Hex() + ".js";
  result->first_bytes += bytes;
  result->all_bytes += bytes;
  return site->WriteText((*list)["script"], script);
}

Error WritePieces(const std::vector<PackPiece>& pieces, const Bytes& pack, Site* site, Json* list, SiteResult* result) {
  Json written = Json::array();
  size_t opens = 0, first = 0;
  for (const PackPiece& piece : pieces) {
    Bytes content;
    Json parts = Json::array();
    for (const ByteRange& part : piece.parts) {
      const auto from = pack.begin() + static_cast<std::ptrdiff_t>(part.offset);
      content.insert(content.end(), from, from + static_cast<std::ptrdiff_t>(part.bytes));
      parts.push_back({part.offset, part.bytes});
    }
    std::string name;
    size_t bytes = 0;
    if (Error e = site->WritePacked(content, &name, &bytes)) return e;
    written.push_back({{"file", name}, {"parts", parts}});
    opens += piece.opens ? 1 : 0;
    first += piece.first ? 1 : 0;
    result->first_bytes += piece.first ? bytes : 0;
    result->all_bytes += bytes;
  }
  (*list)["opens"] = opens;
  (*list)["first"] = first;
  (*list)["pieces"] = written;
  result->pieces = pieces.size();
  return Ok();
}

// At once, where the system can; whoever reads meanwhile finds the old site or the new one.
Error TakePlace(const fs::path& made, const fs::path& folder) {
  std::error_code ec;
  if (!fs::exists(folder, ec)) {
    fs::rename(made, folder, ec);
  } else if (renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) != 0) {
    ec = {errno, std::generic_category()};
  }
  return ec ? Fail(folder.string() + ": cannot be written: " + ec.message()) : Ok();
}

Error OpenPack(const SiteOptions& options, Bytes* bytes, PackFile* file, TourPack* pack) {
  const std::string name = options.pack.string();
  if (Error e = ReadFile(options.pack, bytes)) return e;
  TourPack whole;
  if (Error e = ParseTourPack(*bytes, name, {}, &whole)) return e;
  if (Error e = MakeLighter(options.lighter, bytes)) return Fail(name + ": " + e.message);
  if (Error e = ParseTourPack(*bytes, name, {}, pack)) return e;
  TourPack outline;
  return file->Open(*bytes, name, &outline);
}

}  // namespace

Error WriteSite(const SiteOptions& options, SiteResult* result) {
  const fs::path player = PlayerFolder(options);
  const fs::path folder = fs::absolute(options.folder).lexically_normal();
  if (Error e = CheckPlayer(player)) return e;
  if (Error e = CheckFolder(options.folder)) return e;
  Bytes bytes;
  PackFile file;
  TourPack pack;
  if (Error e = OpenPack(options, &bytes, &file, &pack)) return e;
  const fs::path target = folder.filename().empty() ? folder.parent_path() : folder;
  std::error_code ec;
  fs::create_directories(target.parent_path(), ec);
  TemporaryFolder staging;
  if (Error e = staging.Create(".flaneur_web_", target.parent_path())) return e;
  const fs::path made = staging.path() / "site";
  Site site(made);
  *result = {};
  Json list{{"generator", kGenerator}, {"version", 1}, {"bytes", bytes.size()}};
  if (Error e = WritePage(options, player, pack.language, &site, result)) return e;
  if (Error e = WritePlayer(player, &site, &list, result)) return e;
  if (Error e = WritePieces(PiecesOf(file, pack, bytes.size(), options.limits), bytes, &site, &list, result)) return e;
  if (Error e = site.WriteText(kList, list.dump())) return e;
  result->first_bytes += site.text_bytes();
  result->all_bytes += site.text_bytes();
  return TakePlace(made, target);
}

}  // namespace flaneur
