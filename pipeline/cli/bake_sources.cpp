#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "pipeline/cli/baking.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/core/blender.h"
#include "pipeline/core/child_policy.h"
#include "pipeline/core/fingerprint.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/io/blender_import.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

// Files that a script's options name: they are taken for read, for Blender tells nobody what its own importers open.
void AddNamedFiles(const nlohmann::json& options, const fs::path& folder, std::vector<fs::path>* files) {
  std::error_code ec;
  if (options.is_string()) {
    const fs::path file = folder / options.get<std::string>();
    if (fs::is_regular_file(file, ec)) files->push_back(file);
  } else if (options.is_structured()) {
    for (const auto& each : options) AddNamedFiles(each, folder, files);
  }
}

std::vector<fs::path> FilesOfOptions(const SourceSettings& source, const fs::path& tour) {
  std::vector<fs::path> files;
  AddNamedFiles(nlohmann::json::parse(source.options_json, nullptr, false), tour.parent_path(), &files);
  return files;
}

bool IsUnder(const fs::path& file, const fs::path& folder) { return LiesWithin(file, {folder}); }

// What the script opened beside its own folder and what the key knows already.
Error Reads(const std::vector<fs::path>& files, const SourceSettings& source,
            std::vector<std::pair<std::string, std::string>>* reads) {
  for (const fs::path& file : files) {
    const bool script = file.extension() == ".py" &&
                        (IsUnder(file, source.file.parent_path()) || IsUnder(file, BlenderScriptsFolder()));
    std::string sha256;
    if (script || Sha256OfFile(file, &sha256)) continue;
    reads->emplace_back(file.string(), sha256);
  }
  return Ok();
}

// A script that was killed within its last write may have said that all went well.
Error CheckWhole(const fs::path& glb) {
  std::string bytes;
  if (Error e = ReadTextFile(glb, &bytes)) return e;
  uint32_t length = 0;
  if (bytes.size() >= 12) std::memcpy(&length, bytes.data() + 8, sizeof length);
  if (bytes.compare(0, 4, "glTF") == 0 && length == bytes.size()) return Ok();
  return Fail(glb.filename().string() + ": what the script wrote is no whole glTF binary");
}

struct SourceWork {
  Baking* baking;
  size_t source;
  std::unique_ptr<TemporaryFolder> folder;  // of a script that fails or is interrupted nothing stays
};

Error RunScript(SourceWork* work, Step* step, StageReport* report) {
  Baking* baking = work->baking;
  const SourceSettings& source = SourceOf(*baking, work->source);
  std::error_code ec;
  fs::create_directories(baking->store.folder, ec);
  work->folder = std::make_unique<TemporaryFolder>();
  if (Error e = work->folder->Create(".flaneur_source_", baking->store.folder)) return e;
  step->file = work->folder->path() / (step->item + ".glb");
  nlohmann::json settings{{"output", step->file.string()}, {"seed", source.seed}};
  settings["options"] = nlohmann::json::parse(source.options_json, nullptr, false);
  std::vector<fs::path> read;
  BlenderOptions options;
  options.log_file = work->folder->path() / "log.txt";
  options.sandboxed = !IsUnder(source.file, BlenderScriptsFolder());
  options.readable = {baking->tour.parent_path()};
  for (const fs::path& root : GetChildPolicy().roots) options.readable.push_back(root);
  for (const fs::path& file : step->inputs) options.readable.push_back(file);
  options.writable = {work->folder->path()};
  options.files_read = &read;
  options.progress = [step](double share) { step->progress = share; };
  ProcessResult result;
  if (Error e = RunBlenderScript(fs::absolute(source.file), settings.dump(), options, &result)) return e;
  report->peak_mb = static_cast<double>(result.peak_memory_bytes) / 1e6;
  report->work_s = result.cpu_s;
  if (!fs::is_regular_file(step->file, ec)) {
    return Fail(source.file.string() + ": wrote no " + step->file.filename().string() + ": no such file");
  }
  if (Error e = CheckWhole(step->file)) return e;
  return Reads(read, source, &step->entry.reads);
}

}  // namespace

const SourceSettings& SourceOf(const Baking& baking, size_t source) {
  return source == 0 ? baking.settings.town : baking.settings.avatars[source - 1].source;
}

std::string BlenderSha256(Baking* baking) {
  std::call_once(baking->blender_once, [&] {
    fs::path blender;
    if (!FindBlender(&blender)) baking->blender_sha256 = ProgramSha256(baking->store, blender);
  });
  return baking->blender_sha256;
}

void AddSourceSteps(Baking* baking) {
  baking->source_steps.assign(1 + baking->settings.avatars.size(), -1);
  for (size_t i = 0; i < baking->source_steps.size(); ++i) {
    const SourceSettings& source = SourceOf(*baking, i);
    if (source.file.empty() || !IsScript(source.file)) continue;
    Step* step = AddStep(baking, "source", i == 0 ? "town" : baking->settings.avatars[i - 1].name);
    baking->source_steps[i] = static_cast<int>(IndexOf(*baking, step));
    step->extension = ".glb";
    step->is_file = true;
    step->inputs = {source.file};
    for (const fs::path& file : FilesOfOptions(source, baking->tour)) step->inputs.push_back(file);
    step->key = [baking, i, step] {
      Fingerprint print;
      print.Add(ScriptInputs(SourceOf(*baking, i), BlenderSha256(baking)));
      for (size_t k = 1; k < step->inputs.size(); ++k) print.AddFile(step->inputs[k]);
      return print.Hex();
    };
    const auto work = std::make_shared<SourceWork>();
    work->baking = baking;
    work->source = i;
    step->make = [work, step](StageReport* report, Warnings*) { return RunScript(work.get(), step, report); };
  }
}

std::string ContentOfFile(Baking* baking, const fs::path& file) {
  const std::lock_guard lock(baking->contents_mutex);
  std::string& content = baking->contents[file];
  if (content.empty()) {
    content = Fingerprint().AddFile(file).Hex();
    if (NeedsBlender(file)) content = Fingerprint().Add(content).Add(BlenderSha256(baking)).Hex();
  }
  return content;
}

std::string ContentOf(Baking* baking, size_t source) {
  const int step = baking->source_steps[source];
  if (step < 0) return ContentOfFile(baking, SourceOf(*baking, source).file);
  const Step& made = At(baking->steps, step);
  return made.in_store ? made.entry.sha256 : "to be made from " + made.known_key;
}

Error SourceFile(Baking* baking, size_t source, fs::path* file) {
  const int index = baking->source_steps[source];
  if (index < 0) {
    *file = SourceOf(*baking, source).file;
    return Ok();
  }
  Step* step = &At(baking->steps, index);
  if (Error e = DoStep(baking->store, step)) return e;
  if (Error e = CheckFile(baking->store, step)) return e;
  *file = EntryFile(baking->store, step->known_key, step->extension);
  return Ok();
}

Error BadSource(Baking* baking, size_t source, const Error& error) {
  const int index = baking->source_steps[source];
  const SourceSettings& settings = SourceOf(*baking, source);
  if (index >= 0) DropEntry(baking->store, At(baking->steps, index).known_key);
  const std::string named = index < 0 ? "" : settings.file.string() + " made something that cannot be used: ";
  const std::string place = PlaceOfMessage(baking->settings, error.message);
  return Fail((place.empty() ? PlaceOfFile(baking->settings, settings.file) : place) + named + error.message);
}

}  // namespace flaneur
