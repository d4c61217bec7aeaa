// What an editor pastes into a page of their own to show a tour's site there.
#pragma once
#include <string>

namespace flaneur {

struct SnippetOptions {
  std::string address;  // of the site's folder, such as https://museum.example/tour/
  std::string title, language;
  std::string script;  // of the element, in the site's folder
};

// A frame, which needs no script.
std::string FrameSnippet(const SnippetOptions& options);
// The element <flaneur-tour>, with methods and events.
std::string ElementSnippet(const SnippetOptions& options);

}  // namespace flaneur
