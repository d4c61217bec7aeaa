#include <CLI/CLI.hpp>
#include <cstdio>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/web/serve.h"
#include "pipeline/web/snippets.h"
#include "pipeline/web/write_site.h"

namespace flaneur {

int RunWeb(const Arguments& args) {
  CLI::App app{"Writes a tour as a static web site: any web host can hold its folder.", "flaneur web"};
  SiteOptions options;
  int port = 0;
  app.add_option("PACK", options.pack, "A tour pack (.glb)")->required();
  app.add_option("-o,--output", options.folder, "The site's folder: new, empty, or a site written before")->required();
  app.add_option("--player", options.player, "Folder of the page's player; default: what came with this program");
  app.add_option("--quality", options.lighter.picture_quality, "Of JPEG pictures, 1 to 100; 0: as they are")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  std::string address = "https://example.org/tour/";
  app.add_option("--address", address, "Where the site will stand, for the lines that other pages embed it with")
      ->capture_default_str();
  bool full_atlases = false;
  app.add_flag("--full-atlases", full_atlases, "People far away as fine as in the pack, in four times the bytes");
  auto* serve = app.add_option("--serve", port,
                               "Then shows the site to browsers of this machine, until it is "
                               "interrupted; PORT: 8080 unless named")
                    ->expected(0, 1)
                    ->default_str("8080")
                    ->type_name("PORT")
                    ->check(CLI::Range(0, 65535));
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  if (full_atlases) options.lighter.atlas_levels_left_out = options.lighter.normal_levels_left_out = 0;
  SiteResult result;
  if (Error e = WriteSite(options, &result)) return Report(e);
  std::printf("%s: %.2f MB in %zu pieces, %.2f MB until the first picture\n", options.folder.c_str(),
              static_cast<double>(result.all_bytes) / 1e6, result.pieces,
              static_cast<double>(result.first_bytes) / 1e6);
  const SnippetOptions snippet{address, result.title, result.language, result.element_script};
  std::printf("in another page, as a frame:\n%s\nor as an element:\n%s\n", FrameSnippet(snippet).c_str(),
              ElementSnippet(snippet).c_str());
  if (serve->count() == 0) return 0;
  return Report(ServeSite(options.folder, port == 0 && serve->as<std::string>().empty() ? 8080 : port));
}

}  // namespace flaneur
