#include "pipeline/web/snippets.h"

#include "pipeline/web/html_text.h"

namespace flaneur {
namespace {

std::string Address(const SnippetOptions& options) {
  return Escaped(options.address + (options.address.ends_with('/') ? "" : "/"));
}

}  // namespace

std::string FrameSnippet(const SnippetOptions& options) {
  const std::string language = options.language.empty() ? "" : "#lang=" + Escaped(options.language);
  return "<iframe src=\"" + Address(options) + language + "\" title=\"" + Escaped(options.title) +
         "\" loading=\"lazy\" allow=\"fullscreen; gamepad; autoplay; xr-spatial-tracking\" "
         "style=\"width: 100%; aspect-ratio: 16/9; border: 0\"></iframe>";
}

std::string ElementSnippet(const SnippetOptions& options) {
  const std::string language = options.language.empty() ? "" : " lang=\"" + Escaped(options.language) + "\"";
  return "<script src=\"" + Address(options) + Escaped(options.script) + "\"></script>\n<flaneur-tour src=\"" +
         Address(options) + "\"" + language + " title=\"" + Escaped(options.title) + "\"></flaneur-tour>";
}

}  // namespace flaneur
