// A small driver for fuzz targets where the compiler brings no libFuzzer.
//
// Replays every file named on the command line (a folder: every file in it), then for NDHULL_FUZZ_SECONDS
// seconds (default 5) feeds inputs: pseudo-random bytes, and mutations of the replayed files, which get past
// the first line of a reader. The inputs are those of a fixed seed, NDHULL_FUZZ_SEED (default 1); how many of
// them are reached in the time is the machine's affair. An input that crashes is left as fuzz-crash.bin in
// the working directory, to be replayed with  <target> fuzz-crash.bin  and then kept in the corpus.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestInput = 512;
constexpr std::size_t kMostMutations = 8;

// What is being tried now, for the signal handler. The vector behind it outlives the call.
const std::uint8_t* current_data = nullptr;
std::size_t current_size = 0;

extern "C" void keep_crash(int signal) {
  // Only async-signal-safe calls.
  const int file = open("fuzz-crash.bin", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0) {
    const char note[] = "fuzz: crash, input kept as fuzz-crash.bin\n";
    if (write(file, current_data, current_size) >= 0 && write(STDERR_FILENO, note, sizeof note - 1) >= 0)
      close(file);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void feed(const Bytes& input) {
  current_data = input.data();
  current_size = input.size();
  LLVMFuzzerTestOneInput(input.data(), input.size());
}

Bytes read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    std::fprintf(stderr, "fuzz: cannot read %s\n", path.c_str());
    std::exit(1);
  }
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

/// The files named, folders replaced by their files, in order of name.
std::vector<std::filesystem::path> list_files(int count, char** arguments) {
  std::vector<std::filesystem::path> files;
  for (int index = 1; index < count; ++index) {
    const std::filesystem::path path = arguments[index];
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

class InputMaker {
 public:
  InputMaker(std::vector<Bytes> corpus, std::uint64_t seed) : corpus_(std::move(corpus)), random_(seed) {}

  Bytes next() {
    if (corpus_.empty() || below(2) == 0) return random_bytes();
    Bytes input = corpus_[below(corpus_.size())];
    const std::size_t mutation_count = 1 + below(kMostMutations);
    for (std::size_t mutation = 0; mutation < mutation_count; ++mutation) mutate(input);
    return input;
  }

 private:
  // The bias of % is of no interest here, that every machine draws the same is.
  std::size_t below(std::size_t bound) { return static_cast<std::size_t>(random_() % bound); }
  std::uint8_t byte() { return static_cast<std::uint8_t>(below(256)); }

  Bytes random_bytes() {
    Bytes input(below(kLongestInput + 1));
    for (std::uint8_t& value : input) value = byte();
    return input;
  }

  void mutate(Bytes& input) {
    const std::size_t place = below(input.size() + 1);
    const std::size_t length = std::min(below(16) + 1, input.size() - place);
    const auto at = input.begin() + static_cast<std::ptrdiff_t>(place);
    const Bytes piece(at, at + static_cast<std::ptrdiff_t>(length));
    switch (below(6)) {
      case 0:
        if (length > 0) *at = byte();
        break;
      case 1:
        if (length > 0) *at = static_cast<std::uint8_t>(*at ^ (1u << below(8)));
        break;
      case 2: input.insert(at, byte()); break;
      case 3: input.erase(at, at + static_cast<std::ptrdiff_t>(length)); break;
      case 4:
        input.insert(input.begin() + static_cast<std::ptrdiff_t>(below(input.size() + 1)), piece.begin(),
                     piece.end());
        break;
      default: input.resize(place); break;
    }
  }

  std::vector<Bytes> corpus_;
  std::mt19937_64 random_;
};

double number_from_environment(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr || *text == '\0' ? otherwise : std::strtod(text, nullptr);
}

}  // namespace

int main(int argument_count, char** arguments) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, keep_crash);
  const double seconds = number_from_environment("NDHULL_FUZZ_SECONDS", 5.0);
  const auto seed = static_cast<std::uint64_t>(number_from_environment("NDHULL_FUZZ_SEED", 1.0));

  std::vector<Bytes> corpus;
  for (const auto& path : list_files(argument_count, arguments)) {
    corpus.push_back(read_file(path));
    feed(corpus.back());
  }
  const std::size_t replayed = corpus.size();

  InputMaker maker(std::move(corpus), seed);
  std::uint64_t tried = 0;
  const Clock::time_point start = Clock::now();
  while (std::chrono::duration<double>(Clock::now() - start).count() < seconds) {
    const Bytes input = maker.next();
    feed(input);
    ++tried;
  }
  std::printf("fuzz: %zu files replayed, %llu inputs in %g s, seed %llu\n", replayed,
              static_cast<unsigned long long>(tried), seconds, static_cast<unsigned long long>(seed));
  return 0;
}
