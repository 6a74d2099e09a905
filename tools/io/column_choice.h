// Which columns of a table of points are coordinates.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ndhull {

/// The list of --columns: names of the header, numbers from 1 and ranges of them, as in mass,4,6-9. A name
/// that has a comma, or that several columns have, can be given by number only; 4-4 is a number where a column
/// has the name 4.
class ColumnChoice {
 public:
  /// All columns, as they stand.
  ColumnChoice() = default;
  /// Throws kUsage for an empty item.
  explicit ColumnChoice(std::string list);

  bool is_all() const { return list_.empty(); }
  /// As it was written.
  const std::string& list() const { return list_; }

  /// The columns from 0, in the order of the list.
  ///
  /// names     of the columns, or empty where the file has none
  /// columns   how many the file has
  /// file      its name, for messages
  /// Throws    kUsage for what is no column of the file or could be several, and for one that is listed twice.
  std::vector<std::size_t> resolve(std::span<const std::string> names, std::size_t columns,
                                   const std::string& file) const;

 private:
  std::string list_;
  std::vector<std::string> items_;
};

}  // namespace ndhull
