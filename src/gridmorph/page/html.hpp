// Text, tables and pictures as HTML.
#pragma once

#include <gridmorph/io/png.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::page {

/// Text as it can stand between tags and in quoted attributes: & < > " ' as entities, what is no UTF-8 and what HTML
/// does not allow (control characters) as U+FFFD.
std::string escaped(std::string_view text);

/// Rows of cells, which are HTML already. Columns of numbers stand to the right.
class Table {
 public:
  struct Column {
    std::string title;
    bool number = false;
  };
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  /// In a box of its own that scrolls where the page is narrow.
  [[nodiscard]] std::string html() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// <img> with its size and a description for those who do not see it.
std::string image(io::Picture const& picture, std::string_view description);

/// A figure: what it shows and a caption, which is text.
std::string figure(std::string const& body, std::string_view caption);

}  // namespace gridmorph::page
