#include <gridmorph/plan/make_rows.hpp>

namespace gridmorph {

InterpolationOperator joined(HostInstance const& host, std::span<InterpolationOperator const> parts) {
  InterpolationOperator out;
  std::vector<std::size_t> row, item;
  std::size_t n_rows = 0, n_items = 0;
  for (InterpolationOperator const& part : parts) {
    row.push_back(n_rows);
    item.push_back(n_items);
    n_rows += part.target.size();
    n_items += part.item.size();
  }
  out.target.resize(n_rows);
  out.first.resize(n_rows + 1);
  out.item.resize(n_items);
  out.weight.resize(n_items);
  detail::for_all_parts(host, "gridmorph::join_rows", std::ssize(parts), [&](Index p) {
    auto const& part = parts[p];
    auto const to_row = std::ptrdiff_t(row[p]), to_item = std::ptrdiff_t(item[p]);
    std::copy(part.target.begin(), part.target.end(), out.target.begin() + to_row);
    std::transform(part.first.begin() + 1, part.first.end(), out.first.begin() + 1 + to_row,
                   [&](Index n) { return n + Index(to_item); });
    std::copy(part.item.begin(), part.item.end(), out.item.begin() + to_item);
    std::copy(part.weight.begin(), part.weight.end(), out.weight.begin() + to_item);
  });
  return out;
}

InterpolationOperator gathered(HostInstance const& host, InterpolationOperator const& rows,
                               std::span<Index const> order) {
  InterpolationOperator out;
  out.target.resize(order.size());
  out.first.resize(order.size() + 1);
  for (std::size_t r = 0; r < order.size(); ++r) {
    auto const from = std::size_t(order[r]);
    out.first[r + 1] = out.first[r] + rows.first[from + 1] - rows.first[from];
  }
  out.item.resize(out.first.back());
  out.weight.resize(out.item.size());
  detail::for_all(host, "gridmorph::gather_rows", std::ssize(order), [&](Index r) {
    auto const from = std::size_t(order[r]);
    auto const begin = rows.first[from], end = rows.first[from + 1], to = out.first[r];
    out.target[r] = rows.target[from];
    std::copy(rows.item.begin() + begin, rows.item.begin() + end, out.item.begin() + to);
    std::copy(rows.weight.begin() + begin, rows.weight.begin() + end, out.weight.begin() + to);
  });
  return out;
}

}  // namespace gridmorph
