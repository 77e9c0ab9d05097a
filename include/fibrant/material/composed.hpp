// SPDX-License-Identifier: MIT
#pragma once
/// @file A section law put together of laws of groups of strains, as tests of bundles give them.

#include <fibrant/material/elastic.hpp>

#include <algorithm>

namespace fibrant::material {

/// What a law of one strain, or of the two curvatures, answers.
struct AxialAnswer {
    double force = 0.0, slope = 0.0, bend = 0.0;  ///< N, dN/de, d^2N/de^2 [force]
    double stored = 0.0;                          ///< [force]
};
template <class H>
struct BendingAnswer {
    std::array<double, 2> moment{};
    std::array<double, 3> tangent{};  ///< 11, 12, 22
    [[no_unique_address]] H history{};
    double stored = 0.0, dissipated = 0.0;
};

/// Law of the stretch alone. @param stiffness E A [force]
template <class L>
concept AxialLaw = core::Policy<L> && requires(const L law, double stiffness, double e) {
    { law.response(stiffness, e) } -> std::same_as<AxialAnswer>;
};
/// Law of the curvatures, isotropic: told as those of a round section of the same mean stiffness. @param stiffness E I [force *
/// length^2]
template <class L>
concept BendingLaw = core::Policy<L> && beam::Memory<typename L::History> &&
    requires(const L law, double stiffness, const std::array<double, 2>& b, const typename L::History& accepted) {
    { law.response(stiffness, b, accepted) } -> std::same_as<BendingAnswer<typename L::History>>;
};

/// Axial force of an elastic section.
struct LinearStretch {
    using Parameters = core::NoParameters;
    explicit LinearStretch(const Parameters& = {}) {}
    AxialAnswer response(double stiffness, double e) const noexcept {
        return {stiffness * e, stiffness, 0.0, 0.5 * stiffness * e * e};
    }
};

/// A string: carries tension, and next to nothing in compression. The slope rises from d E A to E A over the strains 0 to e_s.
class NoCompression {
public:
    struct Parameters {
        double left_over = 1e-3;   ///< d, of the stiffness under compression [1], in (0, 1]
        double transition = 1e-3;  ///< e_s [1], > 0
        void validate() const {
            core::require(left_over > 0.0 && left_over <= 1.0, "NoCompression.left_over", left_over, "in (0, 1]");
            core::require_positive("NoCompression.transition", transition);
        }
    };
    explicit NoCompression(const Parameters& parameters) : p_{core::validated(parameters)} {}
    AxialAnswer response(double EA, double e) const noexcept {
        const double d = p_.left_over, s = p_.transition, rest = 1.0 - d;
        if (e <= 0.0) return {EA * d * e, EA * d, 0.0, 0.5 * EA * d * e * e};
        if (e < s)
            return {EA * (d * e + rest * e * e / (2.0 * s)), EA * (d + rest * e / s), EA * rest / s,
                    EA * (0.5 * d * e * e + rest * e * e * e / (6.0 * s))};
        return {EA * (e - 0.5 * rest * s), EA, 0.0, EA * (0.5 * e * e - 0.5 * rest * s * e + rest * s * s / 6.0)};
    }

private:
    Parameters p_;
};

/// Bending moments of an elastic section.
struct LinearBending {
    using Parameters = core::NoParameters;
    using History = beam::NoMemory;
    explicit LinearBending(const Parameters& = {}) {}
    BendingAnswer<History> response(double B, const std::array<double, 2>& b, const History&) const noexcept {
        return {{B * b[0], B * b[1]}, {B, 0.0, B}, {}, 0.5 * B * (b[0] * b[0] + b[1] * b[1]), 0.0};
    }
};

/// Bends over without loss: M = B [f k + (1 - f) k_0 (1 - exp(-k / k_0))], k the curvature.
class SofteningBending {
public:
    struct Parameters {
        double left_over = core::unset;  ///< f, of the stiffness at great curvature [1], in (0, 1]
        double curvature = core::unset;  ///< k_0 [1 / length], > 0
        void validate() const {
            core::require(left_over > 0.0 && left_over <= 1.0, "SofteningBending.left_over", left_over, "in (0, 1]");
            core::require_positive("SofteningBending.curvature", curvature);
        }
    };
    using History = beam::NoMemory;
    explicit SofteningBending(const Parameters& parameters) : p_{core::validated(parameters)} {}
    BendingAnswer<History> response(double B, const std::array<double, 2>& b, const History&) const noexcept {
        const double f = p_.left_over, k0 = p_.curvature, k = std::hypot(b[0], b[1]), y = k / k0, gone = -std::expm1(-y);
        const double secant = B * (f + (1.0 - f) * (y > 0.0 ? gone / y : 1.0)), slope = B * (f + (1.0 - f) * (1.0 - gone));
        // k_0^2 (y - gone), which loses no digits where y is small
        const double stored =
            0.5 * B * f * k * k + B * (1.0 - f) * k0 * k0 * (y > 1e-3 ? y - gone : y * y * (0.5 - y / 6.0 + y * y / 24.0));
        BendingAnswer<History> answer{{secant * b[0], secant * b[1]}, {secant, 0.0, secant}, {}, stored, 0.0};
        if (k > 0.0) {
            const double n0 = b[0] / k, n1 = b[1] / k, more = slope - secant;
            answer.tangent[0] += more * n0 * n0, answer.tangent[1] += more * n0 * n1, answer.tangent[2] += more * n1 * n1;
        }
        return answer;
    }

private:
    Parameters p_;
};

/// Hysteresis of bending by stops in parallel (Prandtl 1928, Ishlinskii 1944): M = f B b + sum m_i, each m_i elastic of stiffness
/// g_i B up to |m_i| = g_i B k_i, where it slides. Its loops close, obey Masing's rule and do not drift. A measured first curve
/// of slope B at first is met at the k_i by g_i = drop of its slope there over B.
template <int Stops>
class BendingStops {
    static_assert(Stops >= 1);
    static constexpr std::size_t count = static_cast<std::size_t>(Stops);

public:
    struct Parameters {
        std::array<double, count> share{};      ///< g_i [1], > 0, at most 1 in all: what is left is f, >= 0
        std::array<double, count> curvature{};  ///< k_i [1 / length], > 0
        void validate() const {
            double sum = 0.0;
            for (std::size_t i = 0; i < count; ++i) {
                core::require_positive("BendingStops.share", share[i]);
                core::require_positive("BendingStops.curvature", curvature[i]);
                sum += share[i];
            }
            core::require(sum <= 1.0 + 1e-12, "BendingStops.share: sum", sum, "<= 1");
        }
        /// Stops that meet a first curve at equal steps of curvature. @param moment  M(k), slope >= 0 that falls; @param
        /// stiffness  its slope at 0
        template <class Moment>
        static Parameters of_curve(const Moment& moment, double stiffness, double step) {
            Parameters p;
            double slope = stiffness;
            for (std::size_t i = 0; i < count; ++i) {
                const double k = step * static_cast<double>(i + 1), next = (moment(k + step) - moment(k)) / step;
                const double own = i == 0 ? (moment(k) - moment(0.0)) / step : slope;
                if (i == 0) slope = own;
                p.curvature[i] = k, p.share[i] = (slope - next) / stiffness;
                slope = next;
            }
            return p;
        }
    };
    struct History {
        std::array<double, 2> curvature{};
        std::array<std::array<double, 2>, count> moment{};  ///< over B
        template <class Self, class See>
        static void visit(Self& h, const See& see) {
            for (auto& b : h.curvature) see(b);
            for (auto& m : h.moment)
                for (auto& c : m) see(c);
        }
        static History between(const History& a, const History& b, double t) {
            History h;
            for (std::size_t c = 0; c < 2; ++c) {
                h.curvature[c] = (1.0 - t) * a.curvature[c] + t * b.curvature[c];
                for (std::size_t i = 0; i < count; ++i) h.moment[i][c] = (1.0 - t) * a.moment[i][c] + t * b.moment[i][c];
            }
            return h;
        }
    };
    explicit BendingStops(const Parameters& parameters) : p_{core::validated(parameters)} {}
    BendingAnswer<History> response(double B, const std::array<double, 2>& b, const History& accepted) const noexcept {
        double left = 1.0;
        for (const double g : p_.share) left -= g;
        left = std::max(0.0, left);
        BendingAnswer<History> answer{
            {left * B * b[0], left * B * b[1]}, {left * B, 0.0, left * B}, {}, 0.5 * left * B * (b[0] * b[0] + b[1] * b[1]), 0.0};
        answer.history.curvature = b;
        for (std::size_t i = 0; i < count; ++i) {
            const double g = p_.share[i], bound = g * p_.curvature[i];
            std::array<double, 2> m{accepted.moment[i][0] + g * (b[0] - accepted.curvature[0]),
                                    accepted.moment[i][1] + g * (b[1] - accepted.curvature[1])};
            const double size = std::hypot(m[0], m[1]);
            if (size > bound * (1.0 + beam::at_bound)) {
                const double n0 = m[0] / size, n1 = m[1] / size, t = B * g * bound / size;
                m = {bound * n0, bound * n1};
                answer.tangent[0] += t * (1.0 - n0 * n0), answer.tangent[1] -= t * n0 * n1,
                    answer.tangent[2] += t * (1.0 - n1 * n1);
                answer.dissipated += B * bound * (size - bound) / g;
            } else {
                answer.tangent[0] += B * g, answer.tangent[2] += B * g;
            }
            for (std::size_t c = 0; c < 2; ++c) answer.moment[c] += B * m[c], answer.history.moment[i][c] = m[c];
            answer.stored += 0.5 * B * (m[0] * m[0] + m[1] * m[1]) / g;
        }
        return answer;
    }

private:
    Parameters p_;
};

/// Stretch by one law, bending by another, torsion, shear and the section elastic. Where the stretch carries less than E A e, the
/// section contracts by less: by nu times N / (E A), or that of a slack bundle would swell.
template <AxialLaw Axial, BendingLaw Bending>
class Composed {
public:
    struct Parameters {
        typename Axial::Parameters axial{};
        typename Bending::Parameters bending{};
        void validate() const { axial.validate(), bending.validate(); }
    };
    using History = typename Bending::History;
    using Section = ElasticSection;
    static constexpr auto entries = beam::detail::with_diagonal(std::array<beam::Entry, 5>{{{strain::e11, strain::e22},
                                                                                            {strain::c12, strain::c21},
                                                                                            {strain::e11, strain::e33},
                                                                                            {strain::e22, strain::e33},
                                                                                            {strain::b1, strain::b2}}});
    static constexpr bool has_rate = false;
    using Answer = beam::SectionAnswer<History, entries.size()>;

    explicit Composed(const Parameters& parameters) : axial_(core::validated(parameters).axial), bending_(parameters.bending) {}
    Section section(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) const {
        return {shape, elastic, shear_factor};
    }
    History fresh(const Section&, const PointPlace&) const noexcept { return {}; }
    Answer response(const Section& section, const SectionStrains& e, const History& accepted, const Drive&) const noexcept {
        Answer answer;
        const double EA = section.diagonal[strain::e33], nu = section.contraction;
        const AxialAnswer N = axial_.response(EA, e[strain::e33]);
        const double slack = nu * (1.0 - N.slope / EA);  // of the contraction, by e
        SectionStrains x = e;
        const double swollen = nu * (e[strain::e33] - N.force / EA);
        x[strain::e11] -= swollen, x[strain::e22] -= swollen, x[strain::e33] = x[strain::b1] = x[strain::b2] = 0.0;
        answer.stress = section.stress(x);
        for (std::size_t c = 0; c < e.size(); ++c) answer.stored += 0.5 * x[c] * answer.stress[c];
        const double both = answer.stress[strain::e11] + answer.stress[strain::e22];
        answer.stress[strain::e33] = N.force - slack * both;
        answer.stored += N.stored;
        const double B1 = section.diagonal[strain::b1], B2 = section.diagonal[strain::b2], B = std::sqrt(B1 * B2),
                     s1 = std::sqrt(B1 / B), s2 = std::sqrt(B2 / B);
        const auto M = bending_.response(B, {s1 * e[strain::b1], s2 * e[strain::b2]}, accepted);
        answer.stress[strain::b1] = s1 * M.moment[0], answer.stress[strain::b2] = s2 * M.moment[1];
        answer.stored += M.stored, answer.dissipated = M.dissipated, answer.history = M.history;
        const auto C = section.tangent();
        std::copy(C.begin(), C.end(), answer.tangent.begin());
        const double c01 = C[12];
        answer.tangent[14] = -slack * (C[0] + c01), answer.tangent[15] = -slack * (C[1] + c01);
        answer.tangent[strain::e33] = N.slope + slack * slack * (C[0] + C[1] + 2.0 * c01) + nu * N.bend / EA * both;
        answer.tangent[strain::b1] = s1 * s1 * M.tangent[0], answer.tangent[strain::b2] = s2 * s2 * M.tangent[2],
        answer.tangent[16] = s1 * s2 * M.tangent[1];
        return answer;
    }

private:
    Axial axial_;
    Bending bending_;
};
static_assert(beam::SectionMaterial<Composed<NoCompression, BendingStops<8>>>);
static_assert(beam::SectionMaterial<Composed<LinearStretch, SofteningBending>>);

}  // namespace fibrant::material
