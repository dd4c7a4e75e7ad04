-- Strength of the prism at every angle of its joint, as blocks and as a mesh, beside Jaeger's curve.
--
--   ./cdem run examples/jointed_prism/study.lua [--set angles=30,60] [--set size=0.03]
local cdem = require "cdem"
local jaeger = require "jaeger"

local angles = cdem.parameter{ name = "angles", default = {20, 40, 60, 75}, range = {5, 75}, unit = "deg",
                               doc = "dips of the joint" }
local size = cdem.parameter{ name = "size", default = 0.05, range = {0.01, 0.1}, unit = "m", doc = "of tetrahedra" }

local all, figures = cdem.linspace(5, 85, 161), {}
local series = { { name = "Jaeger", x = all, y = {} } }
for i, b in ipairs(all) do series[1].y[i] = jaeger.strength(b) end
for _, kind in ipairs{ "blocks", "mesh" } do
  local set, found, worst = {}, {}, 0
  for i, b in ipairs(angles) do set[i] = { model = kind, dip = b, size = size } end
  for i, run in ipairs(cdem.sweep{ script = "case.lua", set = set }) do
    local value, exact = run.figures.strength_Pa, jaeger.strength(angles[i])
    found[i] = value or 0 / 0 -- nil in a check
    worst = worst and value and math.max(worst, math.abs(value / exact - 1))
    figures[#figures + 1] = { name = string.format("%s_%g_Pa", kind, angles[i]), value = value, reference = exact,
                              unit = "Pa", kind = "formula", source = "Jaeger 1960", tolerance = 0.05 }
  end
  series[#series + 1] = { name = kind, x = angles, y = found, style = "points" }
  figures[#figures + 1] = { name = kind .. "_worst_error", value = worst, reference = 0, kind = "formula",
                            source = "Jaeger 1960", tolerance_absolute = 0.05 }
end
cdem.chart{ file = "strength.png", title = "Strength of a prism with one joint", x_label = "dip of the joint (°)",
            y_label = "axial pressure (Pa)", series = series }
cdem.report(figures)
