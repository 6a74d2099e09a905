#include "tools/qhull/qhull_command.h"

#include <memory>
#include <string>
#include <vector>

#include "tools/command_line/command_options.h"
#include "tools/qhull/qhull_options.h"
#include "tools/qhull/qhull_run.h"

namespace ndhull {
namespace {

/// A word of the shell's as it stands in an option string: a file name with blanks, whose quotes the shell has
/// taken, gets some again. `before`: the string so far.
std::string quoted(const std::string& word, const std::string& before) {
  const std::string last = before.substr(before.find_last_of(' ') + 1);
  const bool is_quoted =
      word.size() > 1 && word.front() == word.back() && (word[0] == '\'' || word[0] == '"');
  if ((last != "TI" && last != "TO") || is_quoted || word.find(' ') == std::string::npos) return word;
  const char* const quote = word.find('\'') == std::string::npos ? "'" : "\"";
  return quote + word + quote;
}

struct QhullArguments {
  std::vector<std::string> words;
  unsigned threads = 0;

  QhullCommand parse(QhullProgram program) const {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word, text);
    return parse_qhull_command(text, program);
  }
};

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& description,
                      const std::shared_ptr<QhullArguments>& arguments) {
  CLI::App* const command = app.add_subcommand(name, description);
  command->add_option("OPTIONS", arguments->words, "Qhull's options, in quotes or as words")->type_name("");
  add_threads_option(*command, arguments->threads);
  return command;
}

}  // namespace

void add_qhull_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<QhullArguments>();
  CLI::App* const command = add_command(
      app, "qhull", "The convex hull of standard input, with the options and formats of Qhull.", arguments);
  command->footer(
      "Input    TI FILE, Fd (cdd's, as rbox h writes it); QbB Qbk:n QBk:n Qbb scale it, and what is printed "
      "is "
      "about\n"
      "         the scaled points. Of points that span fewer dimensions the hull is the one in their "
      "subspace\n"
      "Width    Wn (points less than n outside are left out; Vn stands for W of 2n), Cn C-n An A-n (facets "
      "are\n"
      "         merged when the hull is complete, widths certified), Qt Q0 (simplices), QJn QR-n (joggle, "
      "seed)\n"
      "Choice   PAn PFn PMn Pdk:v PDk:v Pg PG\n"
      "Print    n Fo Fi FD FV Fx Fv FN Fn Fc FP i o Ft p Fa FA FC FI Fm FO FQ FS Fs s Ts, Qc Qi, TO FILE Tz "
      "Pp\n"
      "Run      Tv (checks the hull first), TFn (progress), TRn (with QJ: how often joggling fails)\n"
      "Accepted without effect, because all merging is delayed and every distance proven: E Qx Qf Qg Qm Qr "
      "Qs Qv\n"
      "Qw Q1-Q17 Po Ta Tc Tf. U is for Qc. Other options are errors that name what is nearest.\n"
      "Formats are as Qhull's, but i numbers points inside merged facets from the number of points on.\n"
      "Exit code: 0 written, 1 usage or input, 2 Tv failed, 3 internal error, 130 interrupted and "
      "written.\n" +
      example("ndhull rbox \"1000 s D5 t1\" | ndhull qhull \"Qx W1e-1 C1e-2 PA10 FV Fo\" | ndhull qhalf Fp"));
  command->callback([arguments, &exit_code] {
    exit_code = run_qhull(arguments->parse(QhullProgram::kQhull), arguments->threads);
  });
}

void add_qhalf_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<QhullArguments>();
  CLI::App* const command = add_command(
      app, "qhalf", "The intersection of halfspaces, with the options and formats of Qhull's qhalf.",
      arguments);
  command->footer(
      "Input    TI FILE, cdd's too (Fd is accepted); an interior point: the one in the input, else Hx,y,z, "
      "else\n"
      "         one is found\n"
      "Print    Fp (vertices) Fv i (their halfspaces) Fn (their neighbours) Fx (non-redundant halfspaces)\n"
      "         FN (their vertices) FQ Fs s, TO FILE Tz\n"
      "Run      Tv checks that no vertex is above a halfspace\n"
      "Vertices that coincide are one. Where the intersection has no end the points are those of the dual "
      "hull\n"
      "about the interior point, as Qhull's: at infinity they are printed as -10.101. An empty one is an "
      "error.\n"
      "Exit code: 0 written, 1 usage or input, 2 Tv failed, 3 internal error, 130 interrupted and "
      "written.\n" +
      example("ndhull rbox c | ndhull qhull \"FV n\" | ndhull qhalf \"H0,0,0 Fp\""));
  command->callback([arguments, &exit_code] {
    exit_code = run_qhalf(arguments->parse(QhullProgram::kQhalf), arguments->threads);
  });
}

}  // namespace ndhull
