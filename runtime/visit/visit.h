// One visit: what stands behind a window, picture by picture, whatever the hands do.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/frame.h"
#include "runtime/simulation/records.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/kiosk_settings.h"
#include "runtime/visit/loading.h"
#include "runtime/visit/shell.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

// Needs a current OpenGL context for its whole life, and what it is given as long.
class Visit {
 public:
  // kiosk: for PlayerSettings::kiosk.
  Visit(const TourPack& pack, Loader* loader, const PlayerSettings& settings, const Shell& shell,
        Simulation* simulation, const KioskSettings& kiosk = {});
  ~Visit();
  // onto_window: RenderOptions::onto_window. Errors: those of Renderer::Begin.
  Error Begin(bool onto_window = false);
  // Uploads some of what has been loaded; `there` becomes true once there is enough to walk among people. Errors: those
  // of the pack.
  Error Load(bool* there);
  // Once after Load. views: the plan and the graphs are shown.
  Error Enter(bool views);

  // The next picture, of a window of this size, passed_s after the one before; 0 pixels: the window is hidden. Each
  // step of the simulation goes into `records`. Errors: those of the pack, which still streams in.
  Error Picture(const WindowInput& input, int width_px, int height_px, float passed_s, Records* records);
  // What the last picture took until it could be shown, as far as the processor knows; what the graphics card took over
  // the one before, the renderer knows. By the longer the next ones are drawn more coarsely or finely, as the settings
  // say. Who never tells has them as fine as the window.
  void TellTime(float took_ms);
  void Present();                        // onto the window's surface
  void Read(std::vector<uint8_t>* rgb);  // the last picture: RGB, 8 bits a channel, top row first
  void Leave();                          // saves what the visitor has changed
  bool ends() const;                     // the visitor wants to; of a kiosk the operator
  bool waits_for_visitors() const;       // of a kiosk: nobody is there
  bool starts_anew() const;              // so that the program is to be started again
  bool frees_pointer() const;            // to point at things with; else the mouse is caught
  bool fullscreen() const;               // as the visitor has it
  bool shows_pages() const;
  const FrameStatistics& statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
