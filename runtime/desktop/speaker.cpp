#include "runtime/desktop/speaker.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "runtime/desktop/sound.h"
#include "runtime/desktop/warn.h"
#include "runtime/visit/synthesis.h"

namespace flaneur {
namespace {

constexpr size_t kVoices = 20;  // for the town's sounds at a time

// One of them: what goes round keeps its voice from picture to picture.
struct Voice {
  ALuint source = 0;
  int round = -1;  // HeardSound::source of what goes round there; -1: free, or a sound that ends
  bool kept = false;
};

Sound Made(const Recording& recording) {
  if (recording.file == nullptr) return {Synthesize(recording.kind, recording.variant), 1, kSynthesisRate_hz};
  Sound sound = DecodeSound(*recording.file);
  if (sound.channels != 2) return sound;
  for (size_t k = 0; k < sound.samples.size() / 2; ++k)  // one channel: only that has a place
    sound.samples[k] = static_cast<int16_t>((sound.samples[2 * k] + sound.samples[2 * k + 1]) / 2);
  sound.samples.resize(sound.samples.size() / 2);
  sound.channels = 1;
  return sound;
}

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
  std::mutex opening;
  ALCdevice* device = nullptr;
  std::atomic<ALCcontext*> context = nullptr;
  ALuint source = 0, buffer = 0;
  bool tried = false, paused = false, playing = false;
  std::atomic<float> volume = 1;
  std::string name;                   // of the sound that plays or is decoded
  std::set<std::string> undecodable;  // of which that has been said
  Jobs* jobs = nullptr;
  std::vector<Recording> recordings;
  std::vector<Sound> made;      // of them, until they are buffers
  std::vector<ALuint> buffers;  // by recording; 0: nothing to hear
  std::array<Voice, kVoices> voices{};
  std::optional<Job> making;
  Sound decoded;
  std::optional<Job> decoding;  // last, so that it ends first

  // True once there is a device; opens it where that has not been tried. From any thread.
  bool Open() {
    const std::lock_guard<std::mutex> lock(opening);
    if (tried) return context != nullptr;
    tried = true;
    device = alcOpenDevice(nullptr);
    ALCcontext* opened = device == nullptr ? nullptr : alcCreateContext(device, nullptr);
    if (opened == nullptr || !alcMakeContextCurrent(opened)) {
      std::fprintf(stderr, "flaneur-player: no sound: there is no audio device\n");
      return false;
    }
    alGenSources(1, &source);
    alSourcei(source, AL_SOURCE_RELATIVE, AL_TRUE);
    alDistanceModel(AL_NONE);  // how loud a sound is, the town says
    for (Voice& voice : voices) alGenSources(1, &voice.source);
    alListenerf(AL_GAIN, volume);
    context = opened;  // from here on everybody may use all of it
    return true;
  }

  bool HasNoDevice() {
    const std::unique_lock<std::mutex> lock(opening, std::try_to_lock);
    return lock && tried && context == nullptr;
  }

  void FillBuffers() {
    for (const Sound& sound : made) {
      buffers.push_back(0);
      if (context == nullptr || sound.samples.empty()) continue;
      alGenBuffers(1, &buffers.back());
      alBufferData(buffers.back(), AL_FORMAT_MONO16, sound.samples.data(),
                   static_cast<ALsizei>(sound.samples.size() * sizeof(int16_t)), sound.rate_hz);
    }
    made.clear();
  }

  ALuint BufferOf(const HeardSound& sound) const {
    const auto index = static_cast<size_t>(sound.recording);
    return sound.recording >= 0 && index < buffers.size() ? buffers[index] : 0;
  }

  static void Place(const HeardSound& sound, ALuint on) {
    alSource3f(on, AL_POSITION, sound.place.x, sound.place.y, sound.place.z);
    alSourcef(on, AL_GAIN, std::clamp(sound.gain, 0.0f, 4.0f));
    alSourcef(on, AL_PITCH, sound.pitch);
  }

  Voice* FreeVoice() {
    for (Voice& voice : voices) {
      ALint state = 0;
      alGetSourcei(voice.source, AL_SOURCE_STATE, &state);
      if (voice.round < 0 && state != AL_PLAYING) return &voice;
    }
    return nullptr;
  }

  void Begin(const HeardSound& sound, bool goes_round) {
    const ALuint what = BufferOf(sound);
    Voice* voice = what == 0 ? nullptr : FreeVoice();
    if (voice == nullptr) return;
    voice->round = goes_round ? sound.source : -1;
    voice->kept = true;
    alSourcei(voice->source, AL_BUFFER, static_cast<ALint>(what));
    alSourcei(voice->source, AL_LOOPING, goes_round ? AL_TRUE : AL_FALSE);
    Place(sound, voice->source);
    alSourcePlay(voice->source);
  }

  void GoRound(const std::vector<HeardSound>& round) {
    for (Voice& voice : voices) voice.kept = false;
    for (const HeardSound& sound : round) {
      auto* const found = std::find_if(voices.begin(), voices.end(),
                                       [&](const Voice& v) { return v.round >= 0 && v.round == sound.source; });
      if (found == voices.end()) {
        Begin(sound, true);
        continue;
      }
      found->kept = true;
      Place(sound, found->source);
    }
    for (Voice& voice : voices) {
      if (voice.round < 0 || voice.kept) continue;
      alSourceStop(voice.source);
      voice.round = -1;
    }
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
    playing = true;
    if (!paused) alSourcePlay(source);
  }
};

Speaker::Speaker(Jobs* jobs) : impl_(std::make_unique<Impl>()) {
  QuietenLibraries();
  impl_->jobs = jobs;
}

Speaker::~Speaker() {
  impl_->making.reset();
  Stop();
  if (impl_->context != nullptr) {
    alDeleteSources(1, &impl_->source);
    for (Voice& voice : impl_->voices) alDeleteSources(1, &voice.source);
    for (ALuint buffer : impl_->buffers) {
      if (buffer != 0) alDeleteBuffers(1, &buffer);
    }
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(impl_->context);
  }
  if (impl_->device != nullptr) alcCloseDevice(impl_->device);
}

void Speaker::Play(std::vector<uint8_t> sound, std::string name) {
  Impl* impl = impl_.get();
  impl->decoding.reset();
  if (impl->HasNoDevice()) return;
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
  if (impl_->context != nullptr) alListenerf(AL_GAIN, share);
}

void Speaker::Prepare(const std::vector<Recording>& recordings) {
  Impl* impl = impl_.get();
  if (recordings.empty()) return;
  impl->recordings = recordings;
  impl->making = StartJob(
      impl->jobs,
      [impl] {
        if (!impl->Open()) return true;
        impl->made.push_back(Made(impl->recordings[impl->made.size()]));
        return impl->made.size() == impl->recordings.size();
      },
      Urgency::kMeanwhile);
}

void Speaker::Hear(const Heard& heard) {
  Impl& impl = *impl_;
  if (impl.making) {
    impl.making->Advance();
    if (!impl.making->Done()) return;
    impl.making->Wait();
    impl.making.reset();
    impl.FillBuffers();
  }
  if (impl.context == nullptr || impl.buffers.empty()) return;
  const float ahead_x = std::cos(heard.yaw_rad), ahead_y = std::sin(heard.yaw_rad);
  const std::array<ALfloat, 6> axes{ahead_x, ahead_y, 0, 0, 0, 1};
  alListener3f(AL_POSITION, heard.ear.x, heard.ear.y, heard.ear.z);
  alListenerfv(AL_ORIENTATION, axes.data());
  impl.GoRound(heard.round);
  for (const HeardSound& sound : heard.once) impl.Begin(sound, false);
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
