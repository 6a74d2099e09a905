// The point sets of Qhull's program `rbox`, from the same arguments, digit for digit.
//
// Published figures name their input as an rbox command, so the same points must be had without the program.
#pragma once

#include <string>
#include <string_view>

#include "tools/points/point_set.h"

namespace ndhull {

/// Returns what `rbox ARGUMENTS` prints, byte for byte: header line, count, one point a line ("%6.16g"; with
/// 'z' integers; with 'h' the layout of cdd).
///
/// Families  plain cube, Wn, s, x, y, Ln, Ln s, Zn, Zn s (both with Gn), r (polygon, lens outline in 2-d;
///           cone and lens in 3-d; simplex with x or y), l, Mn,m,r, c and d (both with Gn), and with them
///           Cn,r,m Pn,.. On Bn z n h Dn t tn.
/// Seed      'tn' gives it; 't' takes the time and writes it into the header; otherwise a hash of the
///           words, joined by one blank.
/// Throws    Error kUsage naming the argument: what rbox refuses, and what is not reproduced, namely
///           * a command of more than 180 characters (rbox cuts it), a command that starts its self-test
///             (`D4` alone), words quoted by the shell, 't' without a number twice or as '-t';
///           * 'y' with s, l, L, M or Z, 'x' with Z or y, 'l' or 'M' with Z, 'M' with r: one of them wins;
///           * 'M' without a number, 'P' and its numbers with a blank between;
///           * numbers it would overflow, hexadecimal ones, more than 2^31-1 points, 'c' above 26-d,
///             coordinates that do not fit an int with 'z', sets that hold NaN (`1 l`).
/// Not promised  the last digit of r, l and L with another C library than glibc: they use its sine, cosine
///               and arc sine.
/// Cost      O(points x dimension); text and numbers of the whole set are held in memory.
std::string rbox_text(std::string_view arguments);

/// The points of `rbox_text(arguments)` as its reader gets them: every coordinate is rounded to the 16 digits
/// that are printed, so an in-process call and a pipe see the same doubles. With 'h' the leading constant is
/// left out. `header` is the comment of the first line ("rbox 10 s D3", empty with 'n').
/// Throws    as rbox_text.
PointSet rbox(std::string_view arguments);

}  // namespace ndhull
