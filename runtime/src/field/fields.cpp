// SPDX-License-Identifier: BSD-3-Clause
//
// The named fields and their parameters.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/field_parts.hpp"

namespace tegl {

namespace {

using detail::field_by_point;
using detail::FieldPoint;

constexpr double kPi = std::numbers::pi;

/// The length of the coordinates from `first` to before `last`.
double length(const FieldPoint& x, int first, int last) {
  double square = 0;
  for (int a = first; a < last; ++a) square += x[static_cast<std::size_t>(a)] * x[static_cast<std::size_t>(a)];
  return std::sqrt(square);
}

/// What a field is made from.
struct FieldRequest {
  int dim;
  std::vector<FieldParameter> parameters;
  std::uint64_t seed;

  [[nodiscard]] double get(std::string_view name) const {
    return std::find_if(parameters.begin(), parameters.end(),
                        [&](const FieldParameter& one) { return one.name == name; })
        ->value;
  }
  /// A whole number in a range.
  [[nodiscard]] int whole(std::string_view name, int least, int most) const {
    const double value = get(name);
    if (value != std::floor(value) || value < least || value > most)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} is {}; expected a whole number from {} to {}", name, value, least, most));
    return static_cast<int>(value);
  }
  [[nodiscard]] double positive(std::string_view name) const {
    const double value = get(name);
    if (!(value > 0))
      throw Error(ErrorCode::InvalidArgument, fmt::format("{} is {}; expected a positive number", name, value));
    return value;
  }
};

Field make_ball(const FieldRequest& of) {
  const double radius = of.positive("radius");
  return field_by_point(of.dim, [=, dim = of.dim](const FieldPoint& x) { return radius - length(x, 0, dim); });
}

/// Gaussian bumps minus the isovalue; those farther from a row than 6 widths are left out, where they add 1.5e-8.
Field make_metaballs(const FieldRequest& of) {
  const auto dim = static_cast<std::size_t>(of.dim);
  const auto count = static_cast<std::size_t>(of.whole("count", 1, 1000000));
  constexpr std::array<double, 6> kWidths = {0, 0, 0.035, 0.081, 0.1, 0.1};
  const double width = of.get("width") == 0 ? kWidths[dim] : of.positive("width");
  const double level = of.get("level");
  std::vector<FieldPoint> centres(count);
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t a = 0; a < dim; ++a) {
      const std::uint64_t index = b * dim + a;
      centres[b][a] = 1.7 * detail::mixed_unit(of.seed == 0 ? index : detail::mixed_bits(of.seed) + index) - 0.85;
    }
  return Field(of.dim, [=](const double* start, double step, std::size_t samples, double* out) {
    constexpr double kFarthest = 36;
    std::fill_n(out, samples, -level);
    for (const FieldPoint& centre : centres) {
      double rest = 0;
      for (std::size_t a = 1; a < dim; ++a) rest += (start[a] - centre[a]) * (start[a] - centre[a]);
      rest /= width * width;
      if (rest > kFarthest) continue;
      for (std::size_t i = 0; i < samples; ++i) {
        const double x = (start[0] + static_cast<double>(i) * step - centre[0]) / width;
        if (const double square = rest + x * x; square < kFarthest) out[i] += std::exp(-0.5 * square);
      }
    }
  });
}

Field make_gyroid(const FieldRequest& of) {
  const double k = kPi * of.get("periods");
  return field_by_point(of.dim, [=, dim = static_cast<std::size_t>(of.dim)](const FieldPoint& x) {
    double sum = 0;
    for (std::size_t a = 0; a < dim; ++a) sum += std::sin(k * x[a]) * std::cos(k * x[(a + 1) % dim]);
    return sum;
  });
}

/// Level sets near other minimal surfaces: `primitive`, `product` and `sines` weigh the sum of cosines, their product
/// and the product of sines.
Field make_cosines(const FieldRequest& of, double sum_weight, double product_weight, double sines_weight) {
  const double k = kPi * of.get("periods");
  return field_by_point(of.dim, [=, dim = static_cast<std::size_t>(of.dim)](const FieldPoint& x) {
    double sum = 0, product = 1, sines = 1;
    for (std::size_t a = 0; a < dim; ++a) {
      sum += std::cos(k * x[a]);
      product *= std::cos(k * x[a]);
      sines *= std::sin(k * x[a]);
    }
    return sum_weight * sum + product_weight * product + sines_weight * sines;
  });
}

Field make_torus(const FieldRequest& of) {
  const double ring = of.positive("ring");
  const double tube = of.positive("tube");
  return field_by_point(of.dim, [=, dim = of.dim](const FieldPoint& x) {
    return tube - std::hypot(length(x, 0, 2) - ring, length(x, 2, dim));
  });
}

/// A tube around a torus knot, a polyline here; in 4D and 5D around the curve with the other coordinates 0.
Field make_knot(const FieldRequest& of) {
  const int p = of.whole("p", 1, 50);
  const int q = of.whole("q", 1, 50);
  const double ring = of.positive("ring"), inner = of.positive("inner"), tube = of.positive("tube");
  constexpr int kSegments = 600;
  std::vector<std::array<double, 3>> curve;
  for (int i = 0; i <= kSegments; ++i) {
    const double phi = 2 * kPi * i / kSegments;
    const double out = ring + inner * std::cos(q * phi);
    curve.push_back({out * std::cos(p * phi), out * std::sin(p * phi), inner * std::sin(q * phi)});
  }
  return field_by_point(of.dim, [=, dim = of.dim](const FieldPoint& x) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      double along = 0, square = 0, all = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const double edge = curve[i + 1][a] - curve[i][a];
        const double to = x[a] - curve[i][a];
        along += edge * to;
        square += edge * edge;
        all += to * to;
      }
      const double share = std::clamp(along / square, 0.0, 1.0);
      nearest = std::min(nearest, all - 2 * share * along + share * share * square);
    }
    return tube - std::hypot(std::sqrt(std::max(0.0, nearest)), length(x, 3, dim));
  });
}

Field make_moving(const FieldRequest& of) {
  const double radius = of.positive("radius");
  const double travel = of.get("travel");
  return field_by_point(of.dim, [=, dim = of.dim](const FieldPoint& x) {
    return radius - std::hypot(x[0] - travel * x[static_cast<std::size_t>(dim - 1)], length(x, 1, dim - 1));
  });
}

Field make_merging(const FieldRequest& of) {
  const double radius = of.positive("radius"), start = of.get("start"), end = of.get("end");
  return field_by_point(of.dim, [=, dim = of.dim](const FieldPoint& x) {
    const double time = (x[static_cast<std::size_t>(dim - 1)] + 1) / 2;
    const double distance = start + time * (end - start);
    return radius - std::hypot(std::abs(x[0]) - distance, length(x, 1, dim - 1));
  });
}

/// A cube with rounded corners, without cylinders along all axes.
Field make_csg(const FieldRequest& of) {
  const double half = of.positive("half"), radius = of.positive("radius"), bore = of.get("bore");
  return field_by_point(of.dim, [=, dim = static_cast<std::size_t>(of.dim)](const FieldPoint& x) {
    const double distance = length(x, 0, static_cast<int>(dim));
    double value = radius - distance;
    for (std::size_t a = 0; a < dim; ++a) {
      value = std::min(value, half - std::abs(x[a]));
      value = std::min(value, std::sqrt(std::max(0.0, distance * distance - x[a] * x[a])) - bore);
    }
    return value;
  });
}

/// Independent of each other at different points.
Field make_noise(const FieldRequest& of) {
  return field_by_point(
      of.dim, [seed = detail::mixed_bits(of.seed), dim = static_cast<std::size_t>(of.dim)](const FieldPoint& x) {
        std::uint64_t bits = seed;
        for (std::size_t a = 0; a < dim; ++a)
          bits = detail::mixed_bits(bits ^ std::bit_cast<std::uint64_t>(x[a] + 0.0));
        return static_cast<double>(bits >> 11U) * 0x1p-53 - 0.5;
      });
}

Field make_orbital_field(const FieldRequest& of) {
  const auto orbital = [&](const char* n, const char* l, const char* m) {
    return detail::Orbital{of.whole(n, 1, 12), of.whole(l, 0, 11), of.whole(m, -11, 11)};
  };
  const detail::Orbital first = orbital("n", "l", "m"), second = orbital("n2", "l2", "m2");
  const int n = of.dim >= 4 ? std::max(first.n, second.n) : first.n;
  const double extent = of.get("extent") == 0 ? 2.0 * n * n + 4 : of.positive("extent");
  return detail::make_orbital(of.dim, first, second, extent);
}

/// A field with its description.
struct KnownField {
  FieldInfo info;
  Field (*make)(const FieldRequest&);
};

const std::vector<KnownField>& known_fields() {
  const FieldParameter periods{"periods", 2, "periods along each axis"};
  static const std::vector<KnownField> known = {
      {{"ball", "radius minus the distance from the centre", 2, 5, {{"radius", 0.8, "radius"}}}, &make_ball},
      {{"metaballs",
        "a sum of Gaussian bumps at seeded places",
        2,
        5,
        {{"count", 200, "number of bumps"},
         {"width", 0, "sigma; 0: 0.035 in 2D, 0.081 in 3D, 0.1 in 4D and 5D"},
         {"level", 0.5, "subtracted from the sum"}},
        true},
       &make_metaballs},
      {{"gyroid", "the gyroid: sum of sin(k x) cos(k y) over neighbouring axes", 2, 5, {periods}}, &make_gyroid},
      {{"primitive", "Schwarz's P surface: sum of cosines", 2, 5, {periods}},
       [](const FieldRequest& of) { return make_cosines(of, 1, 0, 0); }},
      {{"diamond", "Schwarz's D surface: product of cosines minus product of sines", 2, 5, {periods}},
       [](const FieldRequest& of) { return make_cosines(of, 0, 1, -1); }},
      {{"neovius", "Neovius' surface: 3 sum of cosines + 4 product of cosines", 2, 5, {periods}},
       [](const FieldRequest& of) { return make_cosines(of, 3, 4, 0); }},
      {{"torus",
        "a tube around a circle in the plane of x and y",
        2,
        5,
        {{"ring", 0.6, "radius of the circle"}, {"tube", 0.25, "radius of the tube"}}},
       &make_torus},
      {{"knot",
        "a tube around a torus knot",
        3,
        5,
        {{"p", 2, "turns around the axis"},
         {"q", 3, "turns around the tube"},
         {"ring", 0.55, "radius of the torus"},
         {"inner", 0.25, "radius of its tube"},
         {"tube", 0.1, "radius of the tube around the knot"}}},
       &make_knot},
      {{"moving",
        "a ball that moves along x as the last coordinate grows",
        2,
        5,
        {{"radius", 0.4, "radius"}, {"travel", 0.5, "x at the end of the time"}}},
       &make_moving},
      {{"merging",
        "two balls that approach each other along x as the last coordinate grows",
        2,
        5,
        {{"radius", 0.245, "radius"},
         {"start", 0.5, "distance from the middle at the start"},
         {"end", 0.1, "at the end"}}},
       &make_merging},
      {{"csg",
        "constructive geometry: a cube and a ball, without bores along the axes",
        2,
        5,
        {{"half", 0.6, "half width of the cube"},
         {"radius", 0.78, "of the ball"},
         {"bore", 0.3, "radius of the bores"}}},
       &make_csg},
      {{"orbital",
        "a hydrogen-like wave function; in 2D its plane y = 0, in 4D the density of two through a beat, in 5D with "
        "more of the second one as u grows",
        2,
        5,
        {{"n", 1, "principal quantum number"},
         {"l", 0, "azimuthal quantum number"},
         {"m", 0, "magnetic quantum number"},
         {"n2", 2, "4D, 5D: of the second state"},
         {"l2", 1, "4D, 5D"},
         {"m2", 0, "4D, 5D"},
         {"extent", 0, "Bohr radii at a coordinate of 1; 0: 2 n^2 + 4"}}},
       &make_orbital_field},
      {{"noise", "independent samples, uniform from -0.5 to 0.5", 2, 5, {}, true}, &make_noise},
  };
  return known;
}

}  // namespace

std::vector<FieldInfo> fields() {
  std::vector<FieldInfo> result;
  for (const KnownField& field : known_fields()) result.push_back(field.info);
  return result;
}

Field make_field(std::string_view name, int dim, const std::vector<std::pair<std::string, double>>& parameters,
                 std::uint64_t seed) {
  std::string names;
  const KnownField* found = nullptr;
  for (const KnownField& field : known_fields()) {
    names += (names.empty() ? "" : ", ") + field.info.name;
    if (field.info.name == name) found = &field;
  }
  const auto refuse = [](const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); };
  if (found == nullptr) refuse(fmt::format("no field '{}'; expected {}", name, names));
  if (dim < found->info.least_dim || dim > found->info.most_dim)
    refuse(fmt::format("the field '{}' in {} dimensions; expected {} to {}", name, dim, found->info.least_dim,
                       found->info.most_dim));
  if (seed != 0 && !found->info.has_seed)
    refuse(fmt::format("the field '{}' with the seed {}; expected 0, as it has no random numbers", name, seed));
  FieldRequest request{dim, found->info.parameters, seed};
  for (const auto& [parameter, value] : parameters) {
    std::string known;
    bool is_known = false;
    for (FieldParameter& one : request.parameters) {
      known += (known.empty() ? "" : ", ") + one.name;
      if (one.name != parameter) continue;
      is_known = true;
      one.value = value;
    }
    if (!is_known)
      refuse(fmt::format("the field '{}' has no parameter '{}'; expected {}", name, parameter,
                         known.empty() ? "none" : known));
    if (!std::isfinite(value)) refuse(fmt::format("{} is {}; expected a finite number", parameter, value));
  }
  return found->make(request);
}

}  // namespace tegl
