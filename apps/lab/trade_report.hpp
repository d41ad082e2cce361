// Results of `halflit trade` as JSON, text and Markdown.
#pragma once

#include "apps/lab/trade_bench.hpp"

#include <string>
#include <vector>

namespace halflit::cli {

/// The summary and a table of all rows by time, as Markdown.
[[nodiscard]] std::string trade_table(const std::vector<TradeRow>& rows, const TradeBench& bench);

/// {..., "noise": [low, high], "rows": [...]}: noise is the range of exact's time divided by that of another frame of exact.
[[nodiscard]] std::string trade_json(const std::vector<TradeRow>& rows, const TradeBench& bench);

/// A few lines of text: the cheapest flags for each error, and the bounds that did not hold.
[[nodiscard]] std::string trade_summary(const std::vector<TradeRow>& rows, const TradeBench& bench);

/// The fastest row of the scene's own lobe whose error.p999 is at most `codes`.
struct TradeOffer {
    double codes = 0;
    const TradeRow* row = nullptr;
};
/// Offers by falling accuracy, each row once, at the least error that allows it. Only rows that are surely cheaper than exact: less
/// time by all of the interval of ratios, and by more than exact against itself varies, for another picture. May be empty.
[[nodiscard]] std::vector<TradeOffer> trade_offers(const std::vector<TradeRow>& rows, const TradeSpace& space);
/// Lines for people: what is free, what costs one code, what is not worth it, and what the machine was too noisy to tell.
[[nodiscard]] std::vector<std::string> trade_verdict(const std::vector<TradeRow>& rows, const TradeSpace& space);
/// The row of the scene's own lobe with exact settings.
[[nodiscard]] const TradeRow& exact_row(const std::vector<TradeRow>& rows, const TradeSpace& space);

}  // namespace halflit::cli
