// SPDX-License-Identifier: MIT
#pragma once
/// @file Runs of numbers that go from places of one rank to places of another.

#include <fibrant/distributed/exchange.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// What was sent, by one rank.
struct Traffic {
    Index messages = 0, bytes = 0;             ///< to single partners
    Index gatherings = 0, gathered_bytes = 0;  ///< of all ranks; bytes that this one gave
};

/// `count` numbers at `out` of what rank `from` has, which go to `in` of what rank `to` has.
struct Route {
    int from, to;
    Index out, in, count;
};

/// Routes as one rank sees them. All ranks name them in the same order; those of others may be left out.
class Routes {
public:
    Routes() = default;
    Routes(int rank, const std::vector<Route>& routes) {
        for (const Route& route : routes) {
            if (route.from == rank && route.to == rank) own_.push_back(route);
            if (route.from == route.to) continue;
            if (route.from == rank) sent_.push_back(route), partners_.ranks.push_back(route.to);
            if (route.to == rank) received_.push_back(route), partners_.ranks.push_back(route.from);
        }
        std::sort(partners_.ranks.begin(), partners_.ranks.end());
        partners_.ranks.erase(std::unique(partners_.ranks.begin(), partners_.ranks.end()), partners_.ranks.end());
        std::stable_sort(sent_.begin(), sent_.end(), [](const Route& a, const Route& b) { return a.to < b.to; });
        std::stable_sort(received_.begin(), received_.end(), [](const Route& a, const Route& b) { return a.from < b.from; });
        partners_.first_sent = firsts(sent_, &Route::to), partners_.first_received = firsts(received_, &Route::from);
        out_.resize(core::at(partners_.sent())), in_.resize(core::at(partners_.received()));
    }

    template <Exchange E>
    void move(const E& exchange, std::span<const double> from, std::span<double> to, Traffic& traffic) {
        for (const Route& route : own_) std::copy_n(from.begin() + route.out, route.count, to.begin() + route.in);
        if (exchange.ranks() == 1) return;
        auto next = out_.begin();
        for (const Route& route : sent_) next = std::copy_n(from.begin() + route.out, route.count, next);
        exchange.swap(partners_, out_, in_);
        auto got = in_.cbegin();
        for (const Route& route : received_) std::copy_n(got, route.count, to.begin() + route.in), got += route.count;
        traffic.messages += core::count(partners_.ranks), traffic.bytes += 8 * core::count(out_);
    }

private:
    std::vector<Index> firsts(const std::vector<Route>& routes, int Route::*partner) const {
        std::vector<Index> first(partners_.ranks.size() + 1, 0);
        for (const Route& route : routes) {
            const auto place = std::lower_bound(partners_.ranks.begin(), partners_.ranks.end(), route.*partner);
            first[static_cast<std::size_t>(place - partners_.ranks.begin()) + 1] += route.count;
        }
        for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
        return first;
    }
    Partners partners_;
    std::vector<Route> own_, sent_, received_;
    std::vector<double> out_, in_;
};

}  // namespace fibrant::distributed
