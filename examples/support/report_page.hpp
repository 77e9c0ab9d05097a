// SPDX-License-Identifier: MIT
#pragma once
/// @file report.html: a run as one page that needs no network: whether it is good, what to be warned of, a view of the fibres,
/// figures and curves.

#include "figure_meanings.hpp"
#include "report_plots.hpp"
#include "report_viewer.hpp"
#include "table.hpp"

#include <fibrant/observe/json.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace example {

namespace observe = fibrant::observe;

/// What a page is made of, beside the files increments.csv and parameters.toml of its folder.
struct ReportPage {
    std::string program, unit;    ///< unit of lengths
    observe::JsonObject summary;  ///< as in summary.json
    observe::Palette palette;
    std::vector<std::string> foremost;  ///< keys of the summary that are shown first
};

namespace detail {

/// Value of a key of a summary, as it is written there; empty if there is none.
inline std::string value_of(const observe::JsonObject& summary, std::string_view key) {
    for (const auto& [name, value] : summary.members())
        if (name == key) return value;
    return {};
}
inline double number_of(const observe::JsonObject& summary, std::string_view key) {
    const std::string text = value_of(summary, key);
    return text.empty() || text == "null" ? fibrant::core::unset : std::strtod(text.c_str(), nullptr);
}
/// Lists and objects with the numbers in them of four digits; texts in them as they are.
inline std::string short_numbers(const std::string& value) {
    std::string text;
    bool quoted = false;
    for (std::size_t k = 0; k < value.size();) {
        const char c = value[k];
        const bool number = !quoted && (c == '-' || (c >= '0' && c <= '9'));
        const std::size_t end = number ? std::min(value.find_first_not_of("+-.0123456789eE", k), value.size()) : k + 1;
        const std::string part = value.substr(k, end - k);
        const bool whole = part.find_first_of(".eE") == std::string::npos;
        text += !number || whole ? part : short_number(std::strtod(part.c_str(), nullptr));
        if (c == '"' && (k == 0 || value[k - 1] != '\\')) quoted = !quoted;
        k = end;
    }
    return text;
}
/// A value for a reader: numbers with four digits, texts without quotes.
inline std::string shown(const std::string& value) {
    if (value == "true") return "yes";
    if (value == "false") return "no";
    if (value == "null") return "-";
    if (!value.empty() && value[0] == '"') return observe::xml_escaped(value.substr(1, value.size() - 2));
    if (value.find_first_of("{[") != std::string::npos) return "<pre>" + observe::xml_escaped(short_numbers(value)) + "</pre>";
    if (value.find_first_of(".e") == std::string::npos) return value;
    return short_number(std::strtod(value.c_str(), nullptr));
}

/// A sentence with the units of the scene for those of its brackets, forces in N as in the scene files.
inline std::string with_units(std::string sentence, const std::string& unit_of_length) {
    const std::size_t open = sentence.find('[');
    for (const auto& [general, unit] :
         {std::pair<std::string, std::string>{"force length", "N " + unit_of_length}, {"force", "N"}, {"length", unit_of_length}})
        if (const std::size_t at = open == std::string::npos ? open : sentence.find(general, open); at != std::string::npos)
            sentence.replace(at, general.size(), unit);
    return sentence;
}

/// What a reader has to know before the figures are used: what is seen, and what it means.
struct Warning {
    std::string seen, means;
    bool grave = false;  ///< the result is not to be used
};

/// Of the last row of a table; unset if there is none.
inline double last_of(const Table& table, std::string_view name) {
    const std::size_t column = table.column(name);
    return table.rows() == 0 || column == table.names().size()
               ? fibrant::core::unset
               : std::strtod(table.cell(table.rows() - 1, column).c_str(), nullptr);
}

inline std::vector<Warning> warnings(const observe::JsonObject& summary, const Table& table) {
    constexpr double unseen =
        0.005;  // radii between contact points and the true gap: what `ContactSpacing.largest_unseen` is by default
    constexpr double energy_share = 0.01;   // of what was turned over, beyond which the balance is told
    constexpr double damping_share = 0.01;  // of the forces, beyond which a curve shows it
    constexpr double cut_share = 0.2;       // of the increments, beyond which cuts cost more than increments
    std::vector<Warning> list;
    const auto number = [&](const char* key) { return number_of(summary, key); };
    const auto is_false = [&](const char* key) { return value_of(summary, key) == "false"; };
    if (is_false("converged"))
        list.push_back({"The run stopped: " + shown(value_of(summary, "reason")),
                        "What is shown is its last state that was accepted. The page \"When it says ...\" "
                        "(docs/how-to/messages.md) has cause "
                        "and remedy.",
                        true});
    const double gap = number("least_gap_over_radius"), depth = number("greatest_penetration_over_radius");
    const double wrong = number("wrong_crossings"), missing = number("missing_crossings");
    const bool ended = !is_false("converged");  // what a run that stopped had not yet mended says nothing more
    if (ended && is_false("audit_clean") && wrong + missing > 0.0)
        list.push_back({short_number(wrong) + " crossings are against the pattern, " + short_number(missing) + " are missing.",
                        "Fibres went to the wrong side. Take a smaller gap limit, less tension, or more elements.", true});
    else if (ended && is_false("audit_clean"))
        list.push_back({"Two fibres are " + short_number(-gap) + " radii deep in each other.",
                        "This is more than allowed. Take more elements, or say by output.deepest_over_radius that you accept it.",
                        true});
    if (ended && is_false("topology_clean"))
        list.push_back({"Yarns do not lie above and below each other as the textile says.",
                        "Yarns went through each other. Start with yarns that overlap less, or with more elements.", true});
    if (-gap > std::max(0.0, depth) + unseen && !is_false("audit_clean"))
        list.push_back(
            {"The true gap, " + short_number(gap) + " radii, is deeper than contact points say, " + short_number(depth) + ".",
             "Between contact points the mesh is coarse: fibres bend or flatten within an element. Compare with more elements."});
    if (const double loose = number("residual_over_tolerance"); ended && loose > 1.0)
        list.push_back(
            {"At the end forces balance to " + short_number(loose, "%.3g") + " times solver.residual_tolerance.",
             "The last stage is a path that was solved loosely (looseness). Make that 1 there before you read small forces."});
    if (const double missed = number("energy_error_over_work"); std::abs(missed) > energy_share)
        list.push_back(
            {"The energy balance misses " + short_number(100.0 * missed, "%.2g") + " % of what was turned over.",
             "Friction slid far in single increments, or fibres leapt. Compare with more increments before you use energies."});
    if (const double held = last_of(table, "damping_share"); held > damping_share)
        list.push_back({"Damping holds " + short_number(100.0 * held, "%.2g") + " % of the forces at the end.",
                        "The state has not come to rest. Forces and shape are those of fibres that are still held by springs."});
    if (const double cut = number("rejected_increments") / number("increments"); cut > cut_share)
        list.push_back({short_number(number("rejected_increments")) + " attempts at increments were given up.",
                        "The result is not worse for it, but the run was slow. More increments or more damping may be faster."});
    return list;
}

/// Coordinates of fibres in thousandths of the greatest extent, about the middle.
inline std::string fibres_json(const observe::Snapshot& snapshot, const ReportPage& page) {
    constexpr std::size_t most_points = 60000;  // a browser turns as many smoothly
    fibrant::Vec3 low = fibrant::Vec3::Constant(1e300), high = -low;
    std::size_t points = 0;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres)
        for (const fibrant::Vec3& x : fibre.position) low = low.cwiseMin(x), high = high.cwiseMax(x), ++points;
    if (points == 0) return {};
    const fibrant::Vec3 middle = 0.5 * (low + high), extent = high - low;
    const double size = std::max(extent.maxCoeff(), 1e-300), scale = 1000.0 / size;
    const std::size_t step = points / most_points + 1;
    const auto three = [&](const fibrant::Vec3& x, int digits) {
        std::string text;
        for (int axis = 0; axis < 3; ++axis)
            text += (axis > 0 ? "," : "") + observe::rounded(scale * (x[axis] - middle[axis]), digits);
        return text;
    };
    std::string text = "{\"unit\":" + observe::json_quoted(observe::xml_escaped(page.unit)) +
                       ",\"size\":" + observe::shortest(size) + ",\"across\":" + observe::rounded(extent.norm() / size, 3) +
                       ",\"low\":[" + three(low, 1) + "],\"high\":[" + three(high, 1) + "],\n\"fibres\":[";
    for (std::size_t f = 0; f < snapshot.fibres.size(); ++f) {
        const observe::FibreSnapshot& fibre = snapshot.fibres[f];
        text += std::string(f > 0 ? "," : "") + "\n{\"c\":\"" +
                page.palette.of(static_cast<fibrant::Index>(f), fibre.group).text() +
                "\",\"r\":" + observe::rounded(scale * fibre.section.radius(), 2) + ",\"p\":[";
        for (std::size_t k = 0; k < fibre.position.size(); k += step) text += (k > 0 ? "," : "") + three(fibre.position[k], 1);
        if ((fibre.position.size() - 1) % step != 0) text += "," + three(fibre.position.back(), 1);
        text += "]}";
    }
    return text + "]}";
}

inline constexpr const char* report_style = R"style(
body{font:16px/1.5 system-ui,sans-serif;color:#222;background:#f4f5f7;margin:0}
main{max-width:1120px;margin:0 auto;padding:16px 20px 60px}
h1{font-size:26px;margin:12px 0 8px}h2{font-size:19px;margin:28px 0 8px}
.said{padding:12px 16px;border-radius:8px;border-left:6px solid;background:#fff;margin:10px 0}
.good{border-color:#2e8b57}.bad{border-color:#c0392b}.doubt{border-color:#d9902f}.said b{display:block}
.two{display:grid;grid-template-columns:minmax(0,3fr) minmax(260px,2fr);gap:16px;align-items:start}
.card{background:#fff;border-radius:8px;padding:12px;box-shadow:0 1px 3px #0002}
canvas{width:100%;height:480px;touch-action:none;cursor:grab;display:block}
.bar{display:flex;flex-wrap:wrap;gap:8px;align-items:center;font-size:14px}
button,select{font:inherit;padding:2px 10px;border:1px solid #bbb;border-radius:6px;background:#fafafa;cursor:pointer}
table{border-collapse:collapse;width:100%;font-size:14px;background:#fff}
td,th{text-align:left;padding:4px 8px;border-bottom:1px solid #e5e5e5;vertical-align:top}
td{overflow-wrap:anywhere}td.n{font-variant-numeric:tabular-nums;min-width:6em}td small{color:#666}
.plots,.slices{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(320px,100%),1fr));gap:16px}
.slices{grid-template-columns:repeat(auto-fit,minmax(min(480px,100%),1fr))}
.load{grid-template-columns:repeat(auto-fill,minmax(min(440px,100%),1fr))}
figure{margin:0;background:#fff;border-radius:8px;padding:8px;box-shadow:0 1px 3px #0002}
figure svg,figure img{width:100%;height:auto;display:block}figcaption{font-size:13px;color:#444;padding:2px 8px}
figcaption span{white-space:nowrap;margin-right:10px}figcaption i{display:inline-block;width:18px;height:3px;margin:0 5px 3px 0}
pre{font-size:13px;overflow:auto;margin:0}td pre{white-space:pre-wrap}details{margin:10px 0}summary{cursor:pointer}
@media(max-width:820px){.two{grid-template-columns:minmax(0,1fr)}canvas{height:min(480px,90vw)}main{padding:10px 10px 40px}}
)style";

}  // namespace detail

/// The page as text.
/// @param folder  of the run, whose increments.csv and parameters.toml are shown where they are there
inline std::string report_page(const std::filesystem::path& folder, const ReportPage& page, const observe::Snapshot& snapshot) {
    const Table table(folder / "increments.csv");
    const std::vector<detail::Warning> list = detail::warnings(page.summary, table);
    const bool good = std::none_of(list.begin(), list.end(), [](const auto& warning) { return warning.grave; });
    const std::string name = observe::xml_escaped(page.program + ": " + folder.filename().string());
    std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + name +
                       "</title>\n<meta name=\"viewport\" content=\"width=device-width\">\n<style>" + detail::report_style +
                       "</style>\n</head>\n<body><main>\n<h1>" + name + "</h1>\n";
    text += good ? "<p class=\"said good\"><b>The result is good.</b>Forces balance, and the audit found nothing that is not "
                   "allowed.</p>\n"
                 : "<p class=\"said bad\"><b>Do not use this result.</b>What is wrong is said below.</p>\n";
    for (const detail::Warning& warning : list)
        text += std::string("<p class=\"said ") + (warning.grave ? "bad" : "doubt") + "\"><b>" + warning.seen + "</b>" +
                warning.means + "</p>\n";

    const auto row = [&](const std::string& key, const std::string& value) {
        return "<tr><td>" + std::string(key) + "<br><small>" +
               observe::xml_escaped(detail::with_units(meaning_of(key), page.unit)) + "</small></td><td class=\"n\">" +
               detail::shown(value) + "</td></tr>\n";
    };
    text += "<div class=\"two\"><div class=\"card\">\n<canvas id=\"view\"></canvas>\n<div class=\"bar\">";
    for (const char* view : {"oblique", "front", "side", "top"})
        text += std::string("<button data-view=\"") + view + "\">" + view + "</button>";
    text +=
        "<label>cut across <select id=\"axis\"><option value=\"0\">x</option><option value=\"1\">y</option><option "
        "value=\"2\">z</option></select></label>"
        "<input id=\"cut\" type=\"range\" min=\"0\" max=\"1000\" value=\"1000\" aria-label=\"where it is cut\"><small>drag: "
        "turn; shift "
        "and drag: move; wheel: zoom; two fingers: move and zoom</small></div>\n<noscript>The view needs scripts, which this "
        "browser "
        "does not run. view.svg is a picture of it.</noscript></div>\n";
    text += "<div class=\"card\"><table>\n";
    for (const std::string& key : page.foremost)
        if (const std::string value = detail::value_of(page.summary, key); !value.empty()) text += row(key, value);
    text += "</table></div></div>\n";
    text += detail::load(folder, table, page.unit);
    for (const char* part : {"", "after"}) text += detail::slices(folder / part);
    std::string curves;
    curves += detail::plot(table, "What is out of balance", "residual", {"residual"}, true,
                           "Over the greatest force. Stages on the way may be loose.");
    curves += detail::plot(table, "Deepest contact", "depth / radius", {"greatest_penetration_over_radius"}, true);
    curves += detail::plot(table, "What damping holds", "part of the forces", {"damping_share"}, true,
                           "Near zero at rest. Well above a hundredth, shape and forces are not those of rest.");
    curves += detail::plot(table, "Iterations of Newton's method", "number in the increment", {"newton_iterations"});
    curves += detail::plot(table, "Contacts that press", "number", {"active_contacts"});
    curves += detail::plot(
        table, "Energies", "[N " + page.unit + "]",
        {"external_work", "elastic_energy", "contact_energy", "dissipated", "damped", "energy_error"}, false,
        "<br>Energy error: what the balance misses. It arises in increments in which fibres part, slide or leap far, "
        "and is no error of the shape.");
    if (!curves.empty()) text += "<h2>Over the increments</h2>\n<div class=\"plots\">\n" + curves + "</div>\n";
    text += "<h2>Stages</h2>\n" + detail::stages(table);
    text += "<details><summary>All figures of the run</summary><table>\n";
    for (const auto& [key, value] : page.summary.members()) text += row(key, value);
    text += "</table></details>\n";
    if (std::filesystem::exists(folder / "parameters.toml"))
        text += "<details><summary>The scene, with all values</summary><pre>" +
                observe::xml_escaped(observe::read_file(folder / "parameters.toml")) + "</pre></details>\n";
    text += "</main>\n<script type=\"application/json\" id=\"fibres\">" + detail::fibres_json(snapshot, page) +
            "</script>\n<script>" + report_viewer + "</script>\n</body>\n</html>\n";
    return text;
}

/// Writes report.html into the folder of a run, the last of its files.
template <class Output>
void write_report(const Output& output, const ReportPage& page, const observe::Snapshot& snapshot) {
    observe::write_file(output.folder / "report.html", report_page(output.folder, page, snapshot));
    if (output.ended) output.ended(snapshot, page.summary);
}
/// The same with what the summary says before the counts of iterations shown first, but for those of single edges.
template <class Output>
void write_report(const Output& output, const char* program, const observe::JsonObject& summary,
                  const observe::Snapshot& snapshot) {
    ReportPage page{program, output.unit, summary, {}, {}};
    for (const auto& [key, value] : summary.members()) {
        if (key == "increments") break;
        if (key != "reason" && value.find_first_of("{[") == std::string::npos && is_known(key)) page.foremost.push_back(key);
    }
    page.foremost.push_back("wall_seconds");
    write_report(output, page, snapshot);
}

}  // namespace example
