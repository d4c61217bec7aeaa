// A visit in a web page: as the browser asks for pictures, without a thread of its own. What is written about the
// picture the page shows itself.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/pack/byte_ranges.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

class PageVisit {
 public:
  PageVisit();
  ~PageVisit();
  // What the tour's file has of bytes, before any of them arrives.
  void Expect(size_t bytes);
  // Errors: beyond the end.
  Error Arrive(size_t offset, std::span<const uint8_t> bytes);
  // Once as much is there as a first picture takes. Errors: those of the pack.
  Error Open();
  // Needs a current context, for the visit's whole life. Errors: those of Renderer::Begin.
  Error Begin();
  // A part of what is to be made ready before the first picture; `there`: it is. Errors: of a piece.
  Error Load(bool* there);
  // Errors: of a piece that streams in.
  Error Picture(const WindowInput& input, int width_px, int height_px, float passed_s);
  // The last picture, by the browser's clock: what lay between it and the one before.
  void TellTime(float took_ms);

  // What the page asks for.
  void SetLanguage(const std::string& language);
  void GoToStop(size_t stop);  // from 0; of those that there are
  void TakeTour(bool follows);
  void Pause(bool pauses);
  void WidenView(float factor);  // of the field of view
  // A file of the tour: spoken words; empty while it has not arrived.
  std::span<const uint8_t> Sound(size_t sound) const;
  // What it shows, as JSON, anew after each picture: caption, language, stop, what is spoken there, figures
  // of the picture.
  std::string State() const;
  // The player's and the tour's words in that language, as JSON: phrases and actions by their names, thanks, and what
  // each of the tour's languages is called in itself.
  std::string Words(const std::string& language) const;
  // Of the whole visit: title, languages, names of stops.
  std::string Description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
