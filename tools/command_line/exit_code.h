// How the program ends when it is not with 0.
#pragma once

namespace ndhull {

/// Bad input or usage.
inline constexpr int kBadInputExitCode = 1;
/// Of a run whose --verify found a claim that does not hold.
inline constexpr int kVerificationFailedExitCode = 2;
/// A bug of this program, or no memory.
inline constexpr int kInternalErrorExitCode = 3;
/// Of a run that was interrupted.
inline constexpr int kInterruptedExitCode = 130;

}  // namespace ndhull
