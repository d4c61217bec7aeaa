// What a page calls: page.js turns hands, pieces of the tour and the browser's wishes for pictures into these. Each
// returns an empty text, or what is wrong in one line. Texts are good until the next call.
#include <emscripten/emscripten.h>
#include <emscripten/html5.h>

#include <memory>
#include <new>
#include <string>

#include "runtime/base/text.h"
#include "runtime/web/page_visit.h"

namespace flaneur {
namespace {

std::unique_ptr<PageVisit> visit;
WindowInput input;  // since the last picture
std::bitset<kInputCodes> held;
std::string told;

const char* Told(std::string text) {
  told = std::move(text);
  return told.c_str();
}

const uint8_t* Given(std::span<const uint8_t> bytes, int* count) {
  *count = static_cast<int>(bytes.size());
  return bytes.data();
}

// Whatever goes wrong reaches the page as a sentence.
const char* Try(auto work) {
  try {
    const Error e = work();
    return Told(e ? OneLine(e.message) : "");
  } catch (const std::bad_alloc&) {
    return Told("there is not enough memory for this tour");
  } catch (const std::exception& e) {
    return Told(OneLine(e.what()));
  }
}

Error MakeContext(const char* canvas) {
  EmscriptenWebGLContextAttributes wished;
  emscripten_webgl_init_context_attributes(&wished);
  wished.majorVersion = 2;
  wished.alpha = wished.antialias = wished.stencil = wished.depth = false;  // the renderer has targets of its own
  wished.powerPreference = EM_WEBGL_POWER_PREFERENCE_HIGH_PERFORMANCE;
  const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context = emscripten_webgl_create_context(canvas, &wished);
  if (context <= 0 || emscripten_webgl_make_context_current(context) != EMSCRIPTEN_RESULT_SUCCESS)
    return Fail("this browser does not offer WebGL 2");
  emscripten_webgl_enable_extension(context, "WEBGL_debug_renderer_info");
  return Ok();
}

}  // namespace
}  // namespace flaneur

using namespace flaneur;

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* page_expect(double bytes) {
  return Try([&] {
    visit = std::make_unique<PageVisit>();
    visit->Expect(static_cast<size_t>(bytes));
    return Ok();
  });
}
EMSCRIPTEN_KEEPALIVE const char* page_arrive(double offset, const uint8_t* bytes, double count) {
  return Try([&] { return visit->Arrive(static_cast<size_t>(offset), {bytes, static_cast<size_t>(count)}); });
}
EMSCRIPTEN_KEEPALIVE const char* page_prepare(const char* canvas) {
  return Try([&] {
    if (Error e = MakeContext(canvas)) return e;
    visit->Prepare();
    return Ok();
  });
}
EMSCRIPTEN_KEEPALIVE const char* page_open(const char* settings) {
  return Try([&] { return visit->Open(settings); });
}
EMSCRIPTEN_KEEPALIVE const char* page_begin() {
  return Try([&] { return visit->Begin(); });
}
EMSCRIPTEN_KEEPALIVE const char* page_load(bool* there) {
  return Try([&] { return visit->Load(there); });
}
EMSCRIPTEN_KEEPALIVE const char* page_load_more(bool* all) {
  return Try([&] { return visit->LoadMore(all); });
}
EMSCRIPTEN_KEEPALIVE const char* page_meanwhile(float passed_s) {
  return Try([&] {
    input.down |= held;
    visit->Meanwhile(input, passed_s);
    input = {};
    return Ok();
  });
}
EMSCRIPTEN_KEEPALIVE const char* page_picture(int width_px, int height_px, float passed_s, float took_ms) {
  return Try([&] {
    input.down |= held;
    visit->TellTime(took_ms);
    const Error e = visit->Picture(input, width_px, height_px, passed_s);
    input = {};
    return e;
  });
}

EMSCRIPTEN_KEEPALIVE void page_put_on(float x, float y, float z, float pictures_per_s) {
  visit->PutOnHeadset({x, y, z}, pictures_per_s);
}
EMSCRIPTEN_KEEPALIVE void page_take_off() { visit->TakeOffHeadset(); }
EMSCRIPTEN_KEEPALIVE const char* page_picture_in_room(float x, float y, float z, const float* eyes, int count,
                                                      int framebuffer, float passed_s) {
  return Try([&] {
    input.down |= held;
    const Error e = visit->PictureInRoom(input, {x, y, z}, {eyes, static_cast<size_t>(count) * PageVisit::kFloatsOfEye},
                                         static_cast<unsigned>(framebuffer), passed_s);
    input = {};
    return e;
  });
}
EMSCRIPTEN_KEEPALIVE void page_turn_in_room(float angle_rad) { visit->TurnInRoom(angle_rad); }
// ray: where it begins and its direction; the place comes into its first three. False: nowhere.
EMSCRIPTEN_KEEPALIVE bool page_land(float* ray, bool goes) {
  Vec3 there;
  if (!visit->Land({ray[0], ray[1], ray[2]}, {ray[3], ray[4], ray[5]}, goes, &there)) return false;
  ray[0] = there.x;
  ray[1] = there.y;
  ray[2] = there.z;
  return true;
}

// By the names of WindowInput.
EMSCRIPTEN_KEEPALIVE void page_key(const char* name, bool down) {
  const int code = InputCode(name);
  if (code < 0) return;
  held.set(static_cast<size_t>(code), down);
  if (down) input.down.set(static_cast<size_t>(code));  // however shortly
}
EMSCRIPTEN_KEEPALIVE void page_release_keys() { held.reset(); }
EMSCRIPTEN_KEEPALIVE void page_turn(float x_px, float y_px) { input.turned_px = input.turned_px + Vec2{x_px, y_px}; }
EMSCRIPTEN_KEEPALIVE void page_click(float x, float y) { input.clicks.push_back({x, y}); }
EMSCRIPTEN_KEEPALIVE void page_sticks(float left_x, float left_y, float right_x, float right_y) {
  input.left_stick = {left_x, left_y};
  input.right_stick = {right_x, right_y};
}
EMSCRIPTEN_KEEPALIVE void page_widen(float factor) { visit->WidenView(factor); }
EMSCRIPTEN_KEEPALIVE void page_language(const char* language) { visit->SetLanguage(language); }
EMSCRIPTEN_KEEPALIVE void page_go_to_stop(int stop) { visit->GoToStop(static_cast<size_t>(stop)); }
EMSCRIPTEN_KEEPALIVE void page_take_tour(bool follows) { visit->TakeTour(follows); }
EMSCRIPTEN_KEEPALIVE void page_pause(bool pauses) { visit->Pause(pauses); }
EMSCRIPTEN_KEEPALIVE void page_ask(const char* action) { visit->Ask(action); }
EMSCRIPTEN_KEEPALIVE void page_press(const char* page, int row, int which) { visit->Press(page, row, which); }
EMSCRIPTEN_KEEPALIVE void page_back() { visit->GoBack(); }
EMSCRIPTEN_KEEPALIVE void page_tap_hotspot(int hotspot) { visit->TapHotspot(hotspot); }
EMSCRIPTEN_KEEPALIVE const uint8_t* page_map(int width_px, int height_px, float times) {
  return visit->Map(width_px, height_px, times).data();
}
EMSCRIPTEN_KEEPALIVE const char* page_map_marks() { return Told(visit->MapMarks()); }
EMSCRIPTEN_KEEPALIVE void page_lead_to_place(float x_px, float y_px) { visit->LeadTo(x_px, y_px); }
EMSCRIPTEN_KEEPALIVE void page_lead_to_stop(int stop) { visit->LeadTo(static_cast<size_t>(stop)); }
EMSCRIPTEN_KEEPALIVE bool page_is_busy() { return visit->IsBusy(); }
EMSCRIPTEN_KEEPALIVE bool page_photo_taken() { return visit->photo_taken(); }
EMSCRIPTEN_KEEPALIVE const char* page_settings() { return Told(visit->TakeSettings()); }

// Bytes: where they begin, and into `count` how many; good until the next call.
EMSCRIPTEN_KEEPALIVE const uint8_t* page_spoken(int* count) { return Given(visit->Spoken(), count); }
EMSCRIPTEN_KEEPALIVE const uint8_t* page_recording(int recording, int* count) {
  return Given(visit->RecordingOf(recording), count);
}
EMSCRIPTEN_KEEPALIVE bool page_is_computed(int recording) { return visit->IsComputed(recording); }
EMSCRIPTEN_KEEPALIVE const uint8_t* page_pack_picture(int picture, int* count) {
  return Given(visit->PackPicture(picture), count);
}
EMSCRIPTEN_KEEPALIVE const char* page_sounds() { return Told(visit->Sounds()); }
EMSCRIPTEN_KEEPALIVE const char* page_hotspots() { return Told(visit->HotspotsNow()); }
EMSCRIPTEN_KEEPALIVE const char* page_state() { return Told(visit->State()); }
EMSCRIPTEN_KEEPALIVE const char* page_words(const char* language) { return Told(visit->Words(language)); }
EMSCRIPTEN_KEEPALIVE const char* page_description() { return Told(visit->Description()); }
}
