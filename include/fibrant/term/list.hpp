// SPDX-License-Identifier: MIT
#pragma once
/// @file The terms of a model as a list, and all of them as one: folds. An empty list is nothing.

#include <fibrant/term/term.hpp>

#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

namespace fibrant::term {

/// What pushes on the fibres of a model, beside contacts and what a scene applies: the row `Acts` of a model.
template <class... T>
struct List {
    /// parameters.NAME of each term, by the name in its slot.
    struct Parameters : T::Slot... {};
};

namespace detail {
template <class B, class... T>
    requires(TermFor<T, B>&&...)
void take_list(const List<T...>&);
}  // namespace detail

/// List<...> of terms that can be made for a beam.
template <class L, class B>
concept ListFor = requires(const L& list) {
    detail::take_list<B>(list);
};

namespace detail {
template <class T>
struct Leaf {
    T term;
};
}  // namespace detail

/// The terms of a list on a site.
template <class B, class... T>
class Terms : detail::Leaf<For<T, B>>... {
public:
    /// @param parameters  derives from the slots of those terms that have any
    template <class Parameters>
    Terms(const SiteOf<B>& site, const Parameters& parameters) : detail::Leaf<For<T, B>>{For<T, B>(site, of<T>(parameters))}... {}

    template <class Body>
    void each(const Body& body) {
        (body(get<T>()), ...);
    }
    template <class Body>
    void each(const Body& body) const {
        (body(get<T>()), ...);
    }
    /// Those of one role.
    template <Role role, class Body>
    void of(const Body& body) const {
        each([&]<class One>(const One& one) {
            if constexpr (One::role == role) body(one);
        });
    }
    /// One of them makes the fibres move in time.
    static constexpr bool moves = (Moving<For<T, B>> || ...);
    /// With that one; nothing where there is none.
    template <class Body>
    void moving(const Body& body) {
        each([&]<class One>(One& one) {
            if constexpr (Moving<One>) body(one);
        });
    }
    template <class Body>
    void moving(const Body& body) const {
        each([&]<class One>(const One& one) {
            if constexpr (Moving<One>) body(one);
        });
    }
    template <class One>
    For<One, B>& get() noexcept {
        return static_cast<detail::Leaf<For<One, B>>&>(*this).term;
    }
    template <class One>
    const For<One, B>& get() const noexcept {
        return static_cast<const detail::Leaf<For<One, B>>&>(*this).term;
    }

private:
    template <class One, class Parameters>
    static typename For<One, B>::Parameters of(const Parameters& parameters) {
        using Slot = typename For<One, B>::Slot;
        if constexpr (std::derived_from<Parameters, Slot>) {
            const auto& [own] = static_cast<const Slot&>(parameters);
            return own;
        } else {
            return {};
        }
    }
};

/// Channels that the terms of a list name, in any order.
template <class B, class... T>
std::vector<std::string> channels_of(const List<T...>&, const typename List<T...>::Parameters& parameters) {
    std::vector<std::string> names;
    [[maybe_unused]] const auto add = [&]<class One>(std::type_identity<One>) {
        const auto& [own] = static_cast<const typename One::Slot&>(parameters);
        for (std::string& name : One::channels(own)) names.push_back(std::move(name));
    };
    (add(std::type_identity<For<T, B>>{}), ...);
    return names;
}

}  // namespace fibrant::term
