// `ndhull-bench readme`: the measured tables of READMEs from a folder of results.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <memory>

#include "bench/commands.h"
#include "bench/readme_tables.h"
#include "bench/result_folder.h"
#include "core/error.h"
#include "tools/io/output_file.h"

namespace ndhull {
namespace {

struct ReadmeOptions {
  std::string folder;
  std::vector<std::string> files;
  bool check = false;
};

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::kFileMissing, path + ": cannot be opened");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void run_readme(const ReadmeOptions& options) {
  const std::vector<RunRecord> records = read_result_folder(options.folder);
  for (const std::string& path : options.files) {
    const std::string text = read_file(path), wanted = with_readme_tables(text, path, records);
    if (text == wanted) continue;
    if (options.check) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("{}: its tables are not those of {}; ndhull-bench readme writes them", path,
                              options.folder));
    }
    OutputFile file(path);
    file.write(wanted);
    file.commit();
    fmt::print("{}\n", path);
  }
}

}  // namespace

void add_readme_command(CLI::App& app) {
  const auto options = std::make_shared<ReadmeOptions>();
  CLI::App* command = app.add_subcommand("readme", "write the measured tables of READMEs from results");
  command->add_option("results", options->folder, "a folder of results, as `all` writes it")->required();
  command
      ->add_option("files", options->files,
                   "Markdown; what stands between <!-- table: NAME --> and <!-- end of table --> is replaced")
      ->required();
  command->add_flag("--check", options->check, "change nothing; exit code 1 when a table is another");
  command->footer("Example: ndhull-bench readme bench/results/amd-epyc-2-cores README.md bench/README.md");
  command->callback([options] { run_readme(*options); });
}

}  // namespace ndhull
