#include "pipeline/cli/speech.h"

#include <cstdlib>
#include <sstream>

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/subprocess.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/io/sound_file.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

constexpr double kLoudness_lufs = -18, kMostPeak_dbtp = -2;  // as loud as recordings of speakers are (EBU R 128)
constexpr const char* kVersion = "3";                        // changed when the same text comes out otherwise

std::string ProgramOnPathSha256(const Store& store, const std::string& program) {
  const char* folders = std::getenv("PATH");
  std::istringstream list(folders ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    const std::string sha256 = ProgramSha256(store, fs::path(folder) / program);
    if (!sha256.empty()) return sha256;
  }
  return "";
}

Error RunTool(const std::vector<std::string>& argv, const fs::path& log) {
  ProcessResult result;
  if (Error e = RunProcess(argv, {log, {}, {}}, &result)) return e;
  if (result.exit_status == 0) return Ok();
  std::string text;
  if (ReadTextFile(log, &text)) text.clear();
  return Fail(argv.front() + " failed: " + OneLine(Beginning(text, 200)));
}

}  // namespace

Error Speak(const Speech& speech, const Store& store, fs::path* file) {
  Fingerprint print;
  print.Add(kVersion).Add(speech.text).Add(speech.voice).Add(speech.words_per_minute);
  print.Add(ProgramOnPathSha256(store, "espeak-ng"));
  const std::string key = print.Hex();
  StoreEntry entry;
  entry.step = "speech:" + OneLine(Beginning(speech.text, 40));
  entry.extension = ".ogg";
  *file = EntryFile(store, key, entry.extension);
  if (ReadEntry(store, key, &entry, nullptr)) return Ok();
  TemporaryFolder folder;
  if (Error e = folder.Create(".flaneur_speech_", store.folder)) return e;
  const fs::path text = folder.path() / "text", wave = folder.path() / "spoken.wav", ogg = folder.path() / "spoken.ogg";
  if (Error e = WriteTextFile(text, speech.text)) return e;
  const fs::path log = folder.path() / "log";
  if (Error e = RunTool({"espeak-ng", "-v", speech.voice, "-s", std::to_string(speech.words_per_minute), "-f",
                         text.string(), "-w", wave.string()},
                        log))
    return Fail("voice '" + OneLine(speech.voice) + "': " + e.message);
  double gain_db = 0;
  if (Error e = GainToLoudness_db(wave, kLoudness_lufs, kMostPeak_dbtp, &gain_db)) return e;
  if (Error e = EncodeSpeech(wave, gain_db, ogg)) return e;
  return PutEntry(store, key, entry, "", ogg);
}

}  // namespace flaneur
