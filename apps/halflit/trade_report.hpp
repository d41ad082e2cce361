// The price list as data and as a page.
#pragma once

#include "apps/halflit/run_report.hpp"
#include "apps/halflit/trade_bench.hpp"

#include <string>
#include <vector>

namespace halflit::cli {

/// A line for each row, in the order of the rows, with a head.
[[nodiscard]] std::string trade_csv(const std::vector<TradeRow>& rows, const TradeSpace& space);

/// {..., "noise": [low, high], "rows": [...]}: noise is exact's time against itself.
[[nodiscard]] Json trade_json(const std::vector<TradeRow>& rows, const TradeBench& bench);

/// The front and the cheapest for each error, a few lines for people.
[[nodiscard]] std::string trade_summary(const std::vector<TradeRow>& rows, const TradeBench& bench);

/// One self-contained page; draws the pictures that it shows.
[[nodiscard]] Result<std::string> trade_page(const std::vector<TradeRow>& rows, TradeBench& bench);

/// The fastest first.
[[nodiscard]] std::vector<const TradeRow*> rows_by_time(const std::vector<TradeRow>& rows);
/// The fastest row of the scene's own lobe, budgets included, of which 99.9 % of the pixels are off by no more; null: there is none.
[[nodiscard]] const TradeRow* cheapest_within(const std::vector<TradeRow>& rows, double codes);
/// The row of the scene's own lobe with nothing traded.
[[nodiscard]] const TradeRow& exact_row(const std::vector<TradeRow>& rows, const TradeSpace& space);

}  // namespace halflit::cli
