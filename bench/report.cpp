// `ndhull-bench report`: results of earlier runs as one page that needs nothing else, or as Markdown.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <set>

#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/report_charts.h"
#include "bench/report_page.h"
#include "bench/result_folder.h"
#include "core/error.h"
#include "tools/io/output_file.h"

namespace ndhull {
namespace {

struct ReportOptions {
  std::vector<std::string> results;
  std::string output;
  bool markdown = false;
};

void run_report(const ReportOptions& options) {
  std::vector<RunRecord> records;
  for (const std::string& path : options.results) {
    const bool is_folder = std::filesystem::is_directory(path);
    for (RunRecord& record : is_folder ? read_result_folder(path) : read_records(path))
      records.push_back(std::move(record));
  }
  write_report_page(records, options.output, options.markdown);
}

}  // namespace

void write_report_page(const std::vector<RunRecord>& records, const std::string& path, bool markdown) {
  if (records.empty()) throw Error(ErrorCode::kEmptyInput, "there are no runs to report on");
  const std::vector<ReportSection> sections = report_sections(records);
  std::set<std::string> machines;
  for (const RunRecord& record : records) {
    if (!record.machine.is_null()) machines.insert(machine_line(record.machine));
  }
  const std::string text = markdown ? markdown_report(sections, machines) : html_report(sections, machines);
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void add_report_command(CLI::App& app) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report", "one page of charts and tables of what --json of the other commands wrote");
  command->add_option("results", options->results, "files of JSON lines, or folders of them")->required();
  command->add_option("-o,--output", options->output, "the page; - is standard output")->required();
  command->add_flag("--markdown", options->markdown, "tables as Markdown, without charts");
  command->footer(
      "Example: ndhull-bench report sweep.jsonl scaling.jsonl -o report.html\n"
      "         ndhull-bench report sweep.jsonl --markdown -o -");
  command->callback([options] { run_report(*options); });
}

}  // namespace ndhull
