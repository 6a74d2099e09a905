// Everything a handler touches is in fixed tables: no memory is taken and no lock is held there.
#include "tools/io/sudden_end.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <utility>

namespace ndhull {
namespace {

constexpr std::size_t kSlots = 16;
constexpr std::size_t kLongestName = 1024;

enum SlotState : int { kFree, kTaken, kReady };

struct Slot {
  std::atomic<int> state = kFree;
  std::array<char, kLongestName> name;
  std::uintptr_t begin = 0, end = 0;  // of a mapping
};

using Slots = std::array<Slot, kSlots>;
Slots doomed_files, mappings;

/// A free slot with the name filled in; null when there is none, or the name is too long.
Slot* take(Slots& slots, const std::string& name) {
  if (name.size() >= kLongestName) return nullptr;
  for (Slot& slot : slots) {
    int expected = kFree;
    if (!slot.state.compare_exchange_strong(expected, kTaken)) continue;
    std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
    return &slot;
  }
  return nullptr;
}

void give_back(void* slot) {
  if (slot != nullptr) static_cast<Slot*>(slot)->state = kFree;
}

void say(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // there is nobody to tell
}

void end_after_bus_error(int signal, siginfo_t* info, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (const Slot& slot : mappings) {
    if (slot.state != kReady || address < slot.begin || address >= slot.end) continue;
    say("ndhull: truncated: ");
    say(slot.name.data());
    say(": found that the file became shorter while it was read, expected it to stay; run again when it is "
        "complete\n");
    end_suddenly(1);
  }
  ::signal(signal, SIG_DFL);  // not ours: the instruction raises it again
}

void watch_bus_errors() {
  struct sigaction action {};
  action.sa_sigaction = end_after_bus_error;
  action.sa_flags = SA_SIGINFO;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(SIGBUS, &action, nullptr);
}

void remove_doomed_files() {
  for (const Slot& slot : doomed_files)
    if (slot.state == kReady) ::unlink(slot.name.data());
}

void end_after_signal(int signal) {
  remove_doomed_files();
  ::signal(signal, SIG_DFL);
  ::raise(signal);  // delivered on return: whoever waits sees what ended it
}

/// Signals that someone has chosen to ignore, as nohup does, or to handle stay so. Ctrl-C where nobody waits
/// for it (tools/command_line/interrupt.h) is one of them.
void watch_ends() {
  static const bool is_watched = [] {
    for (const int signal : {SIGTERM, SIGHUP, SIGINT, SIGQUIT, SIGXCPU}) {
      struct sigaction action {};
      if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
      action.sa_handler = end_after_signal;
      ::sigaction(signal, &action, nullptr);
    }
    return true;
  }();
  static_cast<void>(is_watched);
}

}  // namespace

DoomedFile::DoomedFile(const std::string& path) {
  Slot* const slot = take(doomed_files, path);
  if (slot != nullptr) slot->state = kReady;
  slot_ = slot;
  watch_ends();
}

DoomedFile& DoomedFile::operator=(DoomedFile&& other) noexcept {
  std::swap(slot_, other.slot_);
  return *this;
}

DoomedFile::~DoomedFile() { give_back(slot_); }

WatchedMapping::WatchedMapping(const void* data, std::size_t size, const std::string& name) {
  Slot* const slot = take(mappings, name);
  if (slot == nullptr) return;
  slot->begin = reinterpret_cast<std::uintptr_t>(data);
  slot->end = slot->begin + size;
  slot->state = kReady;
  slot_ = slot;
  watch_bus_errors();
}

WatchedMapping& WatchedMapping::operator=(WatchedMapping&& other) noexcept {
  std::swap(slot_, other.slot_);
  return *this;
}

WatchedMapping::~WatchedMapping() { give_back(slot_); }

void end_suddenly(int exit_code) {
  remove_doomed_files();
  ::_exit(exit_code);
}

}  // namespace ndhull
