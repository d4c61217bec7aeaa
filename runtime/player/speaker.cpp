#include "runtime/player/speaker.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <dlfcn.h>
#include <sndfile.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <future>
#include <string>

namespace flaneur {
namespace {

constexpr sf_count_t kMost_frames = 48000 * 3600;

struct Samples {
  std::vector<int16_t> values;  // one or two channels
  int channels = 0, rate_hz = 0;
};

// The bytes as a file for libsndfile.
struct Memory { const std::vector<uint8_t>* bytes; sf_count_t at = 0; };

sf_count_t SizeOf(void* memory) { return static_cast<sf_count_t>(static_cast<Memory*>(memory)->bytes->size()); }

sf_count_t Seek(sf_count_t offset, int whence, void* memory) {
  auto* m = static_cast<Memory*>(memory);
  const sf_count_t from = whence == SEEK_CUR ? m->at : whence == SEEK_END ? SizeOf(memory) : 0;
  m->at = std::clamp<sf_count_t>(from + offset, 0, SizeOf(memory));
  return m->at;
}

sf_count_t Read(void* to, sf_count_t count, void* memory) {
  auto* m = static_cast<Memory*>(memory);
  const sf_count_t n = std::clamp<sf_count_t>(SizeOf(memory) - m->at, 0, count);
  std::memcpy(to, m->bytes->data() + m->at, static_cast<size_t>(n));
  m->at += n;
  return n;
}

sf_count_t Write(const void*, sf_count_t, void*) { return 0; }
sf_count_t Tell(void* memory) { return static_cast<Memory*>(memory)->at; }

// Empty where the bytes are no sound. Of more than two channels the first is heard.
Samples Decode(const std::vector<uint8_t>& bytes) {
  Memory memory{&bytes};
  SF_VIRTUAL_IO io{SizeOf, Seek, Read, Write, Tell};
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open_virtual(&io, SFM_READ, &info, &memory), &sf_close);
  Samples out;
  if (file == nullptr || info.channels < 1 || info.frames < 1 || info.frames > kMost_frames) return out;
  out.channels = info.channels == 2 ? 2 : 1;
  out.rate_hz = info.samplerate;
  std::vector<int16_t> block(static_cast<size_t>(info.channels) * 4096);
  sf_count_t read = 0;
  while ((read = sf_readf_short(file.get(), block.data(), 4096)) > 0) {
    for (size_t frame = 0; frame < static_cast<size_t>(read); ++frame) {
      const int16_t* first = &block[frame * static_cast<size_t>(info.channels)];
      out.values.insert(out.values.end(), first, first + out.channels);
    }
  }
  return out;
}

void SayNothing(const char*, int, const char*, int, const char*, ...) {}

// Where there is no device, OpenAL and ALSA would each have much to say about it. ALSA is there only where OpenAL brings it along.
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
  std::future<Samples> decoding;

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

  void Begin(const Samples& samples) {
    Silence();
    if (context == nullptr || samples.values.empty()) return;
    alGenBuffers(1, &buffer);
    alBufferData(buffer, samples.channels == 2 ? AL_FORMAT_STEREO16 : AL_FORMAT_MONO16, samples.values.data(),
                 static_cast<ALsizei>(samples.values.size() * sizeof(int16_t)), samples.rate_hz);
    alSourcei(source, AL_BUFFER, static_cast<ALint>(buffer));
    alSourcef(source, AL_GAIN, volume);
    playing = true;
    if (!paused) alSourcePlay(source);
  }
};

Speaker::Speaker() : impl_(std::make_unique<Impl>()) { QuietenLibraries(); }

Speaker::~Speaker() {
  if (impl_->decoding.valid()) impl_->decoding.wait();
  impl_->Silence();
  if (impl_->context != nullptr) {
    alDeleteSources(1, &impl_->source);
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(impl_->context);
  }
  if (impl_->device != nullptr) alcCloseDevice(impl_->device);
}

void Speaker::Play(std::vector<uint8_t> sound) {
  Impl* impl = impl_.get();
  if (impl->tried && impl->context == nullptr) return;
  if (impl->decoding.valid()) impl->decoding.wait();
  impl->decoding = std::async(std::launch::async, [impl, bytes = std::move(sound)] { return impl->Open() ? Decode(bytes) : Samples{}; });
}

void Speaker::Stop() {
  if (impl_->decoding.valid()) impl_->decoding.get();
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
  if (!impl_->decoding.valid() || impl_->decoding.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  impl_->Begin(impl_->decoding.get());
}

void Narrate(const Tour& tour, bool holds, const std::vector<std::vector<uint8_t>>& sounds, Narration* last, Speaker* speaker) {
  Narration now{tour.resting ? HaltOf(tour) : 0, tour.resting ? tour.words[HaltOf(tour)].sound : -1, tour.rested_s};
  if (now.sound >= static_cast<int>(sounds.size())) now.sound = -1;
  const bool anew = now.sound != last->sound || now.stop != last->stop || now.rested_s < last->rested_s;
  if (now.sound < 0 && last->sound >= 0) speaker->Stop();
  if (now.sound >= 0 && anew) speaker->Play(sounds[static_cast<size_t>(now.sound)]);
  speaker->SetPaused(holds || tour.holds);
  speaker->Update();
  *last = now;
}

}  // namespace flaneur
