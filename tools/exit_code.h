// How the program ends when it is no error.
#pragma once

namespace ndhull {

/// Of a run whose --verify found a claim that does not hold.
inline constexpr int kVerificationFailedExitCode = 2;
/// Of a run that was interrupted.
inline constexpr int kInterruptedExitCode = 130;

}  // namespace ndhull
