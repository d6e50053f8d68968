#include "trace/pass_table.h"

#include <cmath>

namespace echocine {

PassTable::PassTable(std::span<const LineTrace> lines, std::size_t surfaces)
    : surfaces_(surfaces), heads_(lines.size() * 2 * surfaces) {
  std::size_t count = 0;
  for (const LineTrace& line : lines) count += line.passes.size();
  links_.reserve(count);
  for (std::size_t line = 0; line < lines.size(); ++line)
    for (std::size_t k = lines[line].passes.size(); k-- > 0;) {
      const InterfacePass& pass = lines[line].passes[k];
      std::uint32_t& head = heads_[keyOf(line, pass.surface, pass.entering)];
      links_.push_back({&pass, head});
      head = static_cast<std::uint32_t>(links_.size());
    }
}

const InterfacePass* PassTable::nearestOf(const Link& first, double path_m) const {
  const InterfacePass* best = first.pass;
  for (std::uint32_t at = first.next; at != 0; at = links_[at - 1].next) {
    const InterfacePass* pass = links_[at - 1].pass;
    if (std::abs(pass->path_m - path_m) < std::abs(best->path_m - path_m)) best = pass;
  }
  return best;
}

}  // namespace echocine
