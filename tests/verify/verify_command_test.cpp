// ndhull verify: files in, two lines and an exit code out.
#include "tools/verify_command.h"

#include "tests/io/io_test_support.h"

namespace ndhull {
namespace {

/// Runs the command on two files; the exit code, or -1 when it leaves it alone.
int run(const std::string& points, const std::string& planes, std::string& printed) {
  CLI::App app;
  int exit_code = -1;
  add_verify_command(app, exit_code);
  testing::internal::CaptureStdout();
  try {
    app.parse("verify " + points + " " + planes);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  std::fflush(stdout);
  printed = testing::internal::GetCapturedStdout();
  return exit_code;
}

TEST(VerifyCommandExample, PrintsTheWorstPairAndTellsByExitCode) {
  const Scratch scratch;
  const std::string points = scratch.write("points.csv", "0,0\n3,0\n0,2\n");
  const std::string good = scratch.write("good.csv", "1,0,-4\n0,2,-4\n");
  const std::string bad = scratch.write("bad.csv", "1,0,-4\n0,2,-3\n");
  std::string printed;
  EXPECT_EQ(run(points, good, printed), 0);
  EXPECT_EQ(printed, "worst: point 2 plane 1 distance 0\npass: 0 of 6 pairs of point and plane above\n");
  EXPECT_EQ(run(points, bad, printed), 2);
  EXPECT_EQ(printed, "worst: point 2 plane 1 distance 0.5\nfail: 1 of 6 pairs of point and plane above\n");
}

TEST(VerifyCommandExample, OtherDimensionsAndTwoStandardInputsAreRefused) {
  const Scratch scratch;
  const std::string points = scratch.write("points.csv", "0,0,1\n3,0,1\n");
  const std::string planes = scratch.write("planes.csv", "1,0,-4\n0,2,-4\n");
  std::string printed;
  expect_error(ErrorCode::kUsage, "2-d", [&] { run(points, planes, printed); });
  expect_error(ErrorCode::kUsage, "standard input", [&] { verify_files("-", "-", 1); });
  expect_error(ErrorCode::kFileMissing, "nowhere.csv", [&] { verify_files(points, "nowhere.csv", 1); });
}

}  // namespace
}  // namespace ndhull
