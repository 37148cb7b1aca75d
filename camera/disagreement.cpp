// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/disagreement.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "camera/estimation.h"
#include "camera/parameter_table.h"
#include "camera/trace_checks.h"

namespace tranos::camera {

namespace {

// Something that may be what is wrong.
struct Suspect {
  enum class Kind { kTrace, kUnknown, kBound, kPrior };
  Kind kind;
  std::string name;
  int photograph = -1;  // of a trace or a prior
  int index = -1;       // of the trace or the prior's parameter there, or of the unknown
  int part = -1;        // as Disagreement's
  int rows = 1;
  double fall = 0;  // of χ² without it
  int checked = 1;  // degrees of freedom that go with it

  // What the rest then disagrees by, for each of its degrees of freedom. The one degree added, with
  // a misfit as it should be, keeps a rest that nothing checks from looking better than it may.
  double Rest(double chi2, int dof) const {
    return (std::max(chi2 - fall, 0.0) + 1) / (std::max(dof - checked, 0) + 1);
  }
};

// rᵀ R⁻¹ r, R the block of the redundancy matrix I − J (JᵀJ)⁻¹ Jᵀ: to first order, by how much χ²
// falls when the rows are left out; a square of a studentised residual (Cook and Weisberg,
// Residuals and Influence in Regression, 2.2). What nothing else checks has no part in it.
void LeaveOut(const Eigen::MatrixXd& redundancy, const Eigen::VectorXd& residuals,
              Suspect* suspect) {
  constexpr double kChecked = 1e-6;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(redundancy);
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * residuals;
  suspect->fall = suspect->checked = 0;
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    const double checked = solver.eigenvalues()[i];
    if (checked <= kChecked) continue;
    suspect->fall += along[i] * along[i] / checked;
    ++suspect->checked;
  }
}

std::string NameOfTrace(std::span<const Photograph> photographs, int photograph, int trace) {
  const std::string number = fmt::format("trace {}", trace + 1);
  if (photographs.size() < 2) return number;
  return number + " of " + NameOfPhotograph(photographs, photograph);
}

std::string NameOfPrior(std::span<const Photograph> photographs, int photograph, int parameter) {
  const std::string of = photographs.size() > 1
                             ? fmt::format(" of {}", NameOfPhotograph(photographs, photograph))
                             : "";
  return fmt::format("the prior of the {}{}", kParameterRows[parameter].words, of);
}

// All suspects in the order of the rows, with the falls to first order.
std::vector<Suspect> SuspectsOf(const Task& task, const Refined& refined, const Linearised& at) {
  using Kind = Suspect::Kind;
  const Determined determined =
      DeterminedOf(task.photographs, task.unknowns, task.layout, refined, at);
  const Eigen::MatrixXd& j = determined.jacobian;
  const Eigen::MatrixXd& inverse = determined.determination.inverse_information;
  std::vector<Suspect> suspects;
  const auto add = [&](int first_row, Suspect suspect) {
    const auto block = j.middleRows(first_row, suspect.rows);
    const Eigen::MatrixXd redundancy =
        Eigen::MatrixXd::Identity(suspect.rows, suspect.rows) - block * inverse * block.transpose();
    LeaveOut(redundancy, at.residuals.segment(first_row, suspect.rows), &suspect);
    suspects.push_back(std::move(suspect));
  };
  for (std::size_t i = 0; i < task.layout.traces.size(); ++i) {
    const TraceRows& rows = task.layout.traces[i];
    add(rows.first_row, {Kind::kTrace, NameOfTrace(task.photographs, rows.photograph, rows.trace),
                         rows.photograph, rows.trace, static_cast<int>(i), rows.rows});
  }
  int row = task.layout.trace_rows;
  for (int i = 0; i < task.layout.unknowns; ++i) {
    const Unknown& unknown = task.unknowns[i];
    const int part = static_cast<int>(task.layout.traces.size()) + i;
    if (unknown.sigma > 0) add(row++, {Kind::kUnknown, NameOfUnknown(unknown), -1, i, part});
    if (refined.at_bound.empty() || !refined.at_bound[i]) continue;
    // What χ² would fall by along the slope that the bound holds.
    const int column = task.layout.unknown_column() + i;
    const double slope = j.col(column).dot(at.residuals);
    suspects.push_back({Kind::kBound, "the bound of " + NameOfUnknown(unknown), -1, i, part, 1,
                        slope * slope * inverse(column, column)});
  }
  for (int p = 0; p < task.layout.cameras; ++p) {
    for (int i = 0; i < kIntrinsics; ++i) {
      if (!(task.photographs[p].priors[i].sigma > 0)) continue;
      add(row++, {Kind::kPrior, NameOfPrior(task.photographs, p, i), p, i});
    }
  }
  return suspects;
}

// So uncertain that it says nothing; its rows stay.
constexpr double kAsGoodAsNothing = 1e6;

void Doubt(Trace& trace) {
  std::visit(
      [](auto& t) {
        if constexpr (requires { t.line; }) {
          t.line.centre_sigma_px *= kAsGoodAsNothing, t.line.tilt_sigma_px *= kAsGoodAsNothing;
        } else {
          t.sigma_px *= kAsGoodAsNothing;
        }
      },
      trace);
}

// χ² by which all else is better off without a suspect, adjusted again, from where it is and from
// the start, for a blunder may have taken the camera to another place; to first order where it is
// not found.
double FallOf(const Task& task, const Refined& refined, double chi2, const Suspect& suspect) {
  std::vector<Photograph> photographs(task.photographs.begin(), task.photographs.end());
  std::vector<Unknown> unknowns(task.unknowns.begin(), task.unknowns.end());
  switch (suspect.kind) {
    case Suspect::Kind::kTrace:
      Doubt(photographs[suspect.photograph].traces[suspect.index]);
      break;
    case Suspect::Kind::kUnknown:
      unknowns[suspect.index].sigma *= kAsGoodAsNothing;
      break;
    case Suspect::Kind::kBound:
      unknowns[suspect.index].min = -std::numeric_limits<double>::infinity();
      unknowns[suspect.index].max = std::numeric_limits<double>::infinity();
      break;
    case Suspect::Kind::kPrior:
      photographs[suspect.photograph].priors[suspect.index].sigma *= kAsGoodAsNothing;
      break;
  }
  const Task without{photographs, unknowns, task.numbers_of, task.layout, task.refine};
  double rest = chi2 - suspect.fall;
  const auto nearby = RefineAgain(without, refined);
  if (nearby) rest = nearby->chi2;
  const Eigen::VectorXd u = StartsOf(unknowns);
  const auto numbers = task.numbers_of(u);
  const auto anew = numbers ? Adjust(without, *numbers, u) : tl::unexpected(numbers.error());
  if (anew) rest = nearby ? std::min(rest, anew->best.chi2) : anew->best.chi2;
  return chi2 - rest;
}

std::string SentenceOf(const Task& task, const Suspect& worst, const Suspect* rival, double chi2,
                       int dof) {
  using Kind = Suspect::Kind;
  const bool is_direction =
      worst.kind == Kind::kTrace && std::holds_alternative<DirectionTrace>(
                                        task.photographs[worst.photograph].traces[worst.index]);
  const char* const what =
      is_direction ? "the edges' directions are not parallel or orthogonal as they are said to be"
      : worst.kind == Kind::kPrior ? "what is assumed of the camera and what is traced disagree"
                                   : "dimensions and traces disagree";
  return fmt::format(
      "{}, or the noise is larger than stated: χ² is {:.4g} with {} degrees of freedom, and {} is "
      "farthest off{}",
      what, chi2, dof, worst.name,
      rival ? fmt::format("; without {} the rest agrees as well", rival->name) : "");
}

}  // namespace

Disagreement DisagreementAt(const Task& task, const Refined& refined, const Linearised& at,
                            double chi2, int dof) {
  constexpr std::size_t kTried = 8;
  constexpr double kAlike = 0.01;
  std::vector<Suspect> suspects = SuspectsOf(task, refined, at);
  const auto rest = [&](const Suspect& suspect) { return suspect.Rest(chi2, dof); };
  std::vector<std::size_t> order(suspects.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return rest(suspects[i]); });
  order.resize(std::min(order.size(), kTried));
  for (const std::size_t i : order) suspects[i].fall = FallOf(task, refined, chi2, suspects[i]);
  std::ranges::sort(order);
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) least = std::min(least, rest(suspects[i]));
  const double alike = least + kAlike * chi2 / dof;
  const Suspect *worst = nullptr, *rival = nullptr;
  for (const std::size_t i : order) {
    if (rest(suspects[i]) > alike) continue;
    rival = worst;
    worst = &suspects[i];
  }
  Disagreement result;
  result.text = SentenceOf(task, *worst, rival, chi2, dof);
  result.part = worst->part;
  result.other_part = rival ? rival->part : -1;
  return result;
}

}  // namespace tranos::camera
