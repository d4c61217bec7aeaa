#include "runtime/desktop/speaker.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>

#include "runtime/desktop/sound.h"
#include "runtime/desktop/warn.h"

namespace flaneur {
namespace {

void SayNothing(const char*, int, const char*, int, const char*, ...) {}

// Where there is no device, OpenAL and ALSA would each have much to say about it. ALSA is there only where OpenAL
// brings it along.
void QuietenLibraries() {
  ::setenv("ALSOFT_LOGLEVEL", "0", 0);
  using SetHandler = int (*)(decltype(&SayNothing));
  if (void* set = ::dlsym(RTLD_DEFAULT, "snd_lib_error_set_handler")) reinterpret_cast<SetHandler>(set)(&SayNothing);
}

}  // namespace

struct Speaker::Impl {
  ALCdevice* device = nullptr;
  ALCcontext* context = nullptr;
  ALuint source = 0, buffer = 0;
  bool tried = false, paused = false, playing = false;
  float volume = 1;
  std::string name;                   // of the sound that plays or is decoded
  std::set<std::string> undecodable;  // of which that has been said
  Jobs* jobs = nullptr;
  Sound decoded;
  std::optional<Job> decoding;  // last, so that it ends first

  // True once there is a device; opens it where that has not been tried.
  bool Open() {
    if (tried) return context != nullptr;
    tried = true;
    device = alcOpenDevice(nullptr);
    if (device != nullptr) context = alcCreateContext(device, nullptr);
    if (context == nullptr || !alcMakeContextCurrent(context)) {
      std::fprintf(stderr, "flaneur-player: no sound: there is no audio device\n");
      return false;
    }
    alGenSources(1, &source);
    alSourcei(source, AL_SOURCE_RELATIVE, AL_TRUE);
    return true;
  }

  void Silence() {
    playing = false;
    if (context == nullptr) return;
    alSourceStop(source);
    alSourcei(source, AL_BUFFER, 0);
    if (buffer != 0) alDeleteBuffers(1, &buffer);
    buffer = 0;
  }

  void Begin(const Sound& sound) {
    Silence();
    if (context == nullptr) return;
    if (sound.samples.empty()) {
      if (undecodable.insert(name).second) Warn("the sound of " + name + " cannot be decoded; nothing is heard there");
      return;
    }
    alGenBuffers(1, &buffer);
    alBufferData(buffer, sound.channels == 2 ? AL_FORMAT_STEREO16 : AL_FORMAT_MONO16, sound.samples.data(),
                 static_cast<ALsizei>(sound.samples.size() * sizeof(int16_t)), sound.rate_hz);
    alSourcei(source, AL_BUFFER, static_cast<ALint>(buffer));
    alSourcef(source, AL_GAIN, volume);
    playing = true;
    if (!paused) alSourcePlay(source);
  }
};

Speaker::Speaker(Jobs* jobs) : impl_(std::make_unique<Impl>()) {
  QuietenLibraries();
  impl_->jobs = jobs;
}

Speaker::~Speaker() {
  Stop();
  if (impl_->context != nullptr) {
    alDeleteSources(1, &impl_->source);
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(impl_->context);
  }
  if (impl_->device != nullptr) alcCloseDevice(impl_->device);
}

void Speaker::Play(std::vector<uint8_t> sound, std::string name) {
  Impl* impl = impl_.get();
  impl->decoding.reset();
  if (impl->tried && impl->context == nullptr) return;
  impl->name = std::move(name);
  impl->decoding = StartJob(impl->jobs, [impl, bytes = std::move(sound)] {
    impl->decoded = impl->Open() ? DecodeSound(bytes) : Sound{};
    return true;
  });
}

void Speaker::Stop() {
  impl_->decoding.reset();
  impl_->Silence();
}

void Speaker::SetPaused(bool paused) {
  if (paused == impl_->paused) return;
  impl_->paused = paused;
  if (!impl_->playing) return;
  if (paused) alSourcePause(impl_->source);
  else alSourcePlay(impl_->source);
}

void Speaker::SetVolume(float share) {
  impl_->volume = share;
  if (impl_->playing) alSourcef(impl_->source, AL_GAIN, share);
}

void Speaker::Update() {
  if (!impl_->decoding) return;
  impl_->decoding->Advance();
  if (!impl_->decoding->Done()) return;
  impl_->decoding->Wait();  // says what went wrong
  impl_->decoding.reset();
  impl_->Begin(impl_->decoded);
}

}  // namespace flaneur
