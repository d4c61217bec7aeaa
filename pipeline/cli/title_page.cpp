#include "pipeline/cli/title_page.h"

#include "pipeline/pictures/picture_files.h"

namespace flaneur {

void ReadTitlePageSettings(TomlTable table, TitlePageSettings* settings) {
  table.File("picture", &settings->picture);
  table.File("logo", &settings->logo);
  table.Color("background", &settings->background);
  table.Finish();
}

std::vector<std::filesystem::path> FilesOf(const TitlePageSettings& settings) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : {settings.picture, settings.logo}) {
    if (!file.empty()) files.push_back(file);
  }
  return files;
}

Error MakeTitlePage(const TitlePageSettings& settings, TitlePage* page) {
  page->background = settings.background;
  if (!settings.picture.empty()) {
    if (Error e = ScaledPicture(settings.picture, kMaxTitlePicture_px, &page->picture)) return e;
  }
  return settings.logo.empty() ? Ok() : ScaledPicture(settings.logo, kMaxTitleLogo_px, &page->logo);
}

}  // namespace flaneur
