// A visit in a web page: as the browser asks for pictures, without a thread of its own. What is written about the
// picture the page shows itself.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/math.h"
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
  // Needs a current context, for the visit's whole life. What takes long without the tour begins.
  void Prepare();
  // Once as much is there as a pack is opened with. settings: what TakeSettings gave in an earlier visit, or lines of
  // it. Errors: those of the pack.
  Error Open(const std::string& settings);
  // Once as much is there as a first picture takes. Errors: those of Renderer::Begin.
  Error Begin();
  // A part of what is to be made ready before the first picture; `there`: it is. Errors: of a piece.
  Error Load(bool* there);
  // A part of what streams in, as a task of its own between pictures; `all`: nothing is left. Uploads once a picture:
  // more would wait for its being drawn. Errors: of a piece.
  Error LoadMore(bool* all);
  // Between pictures that take long: what hands do in so much of the time until the next one, and a step at most; the
  // picture itself goes through the rest.
  void Meanwhile(const WindowInput& input, float passed_s);
  Error Picture(const WindowInput& input, int width_px, int height_px, float passed_s);
  bool IsBusy() const;  // still at the last picture, in software
  // The last picture, by the browser's clock: what lay between it and the one before.
  void TellTime(float took_ms);

  // With a headset, in whose room x is to the right, y up from the floor, z behind; `head` is in it. pictures_per_s:
  // the headset's.
  void PutOnHeadset(Vec3 head, float pictures_per_s);
  void TakeOffHeadset();
  // eyes: kFloatsOfEye each, the projection and the view column by column, where the eye is, and left, bottom, width
  // and height of its part of the framebuffer. Sticks walk to where the head looks. Errors: of a piece that streams in.
  static constexpr size_t kFloatsOfEye = 39;
  Error PictureInRoom(const WindowInput& input, Vec3 head, std::span<const float> eyes, unsigned framebuffer,
                      float passed_s);
  void TurnInRoom(float angle_rad);  // to the left
  // Where a ray meets ground to stand on; goes: the visitor is there at once. False: nowhere.
  bool Land(Vec3 from, Vec3 along, bool goes, Vec3* there);

  // What the page asks for.
  void SetLanguage(const std::string& language);
  void GoToStop(size_t stop);  // from 0; of those that there are
  void TakeTour(bool follows);
  void Pause(bool pauses);
  void WidenView(float factor);         // of the field of view
  void Ask(const std::string& action);  // by its name in settings: menu, map, photo, ask, tour, pause, next, back
  // On the visitor's page of that name: its row, and of a choice which button, of an amount how many steps.
  void Press(const std::string& page, int row, int which);
  void GoBack();                 // to the page before, or out of the pages
  void TapHotspot(int hotspot);  // it tells, or ends
  // The map's picture: RGBA, top row first; good until the next one. Then what stands on it, as JSON, and the way to a
  // place or a stop of it.
  const std::vector<uint8_t>& Map(int width_px, int height_px, float times);
  std::string MapMarks() const;
  void LeadTo(float x_px, float y_px);
  void LeadTo(size_t stop);

  // The last picture was drawn for a photo; the canvas shows it.
  bool photo_taken() const;
  // What sounds now, as JSON, and the files it names; empty while they have not arrived.
  std::string Sounds();
  std::span<const uint8_t> Spoken() const;
  std::span<const uint8_t> RecordingOf(int recording);
  bool IsComputed(int recording) const;  // samples rather than a file
  std::span<const uint8_t> PackPicture(int picture) const;
  // What the visitor has changed, to be kept for the next visit; empty: nothing since it was asked last.
  std::string TakeSettings();
  // What it shows, as JSON, anew after each picture: caption, language, stop, the page that is open, figures of the
  // picture.
  std::string State();
  // Marks of hotspots in the last picture, and what one of them tells, as JSON.
  std::string HotspotsNow() const;
  // The player's own words in that language, as JSON: phrases and actions by their names.
  std::string Words(const std::string& language) const;
  // Of the whole visit: title, languages, names of stops.
  std::string Description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
