-- The elastic plate of example 4.1: what the joints' thickness L costs, and what finer blocks gain.
--
--   ./cdem run examples/uniaxial_compression/study.lua
--
-- Cases run side by side. A finite-element mesh without joints gives a mean top displacement of -2.7375e-4 m.
local cdem = require "cdem"

local fine = -2.7375e-4 -- m
local ratios, divisions = {0.1, 0.05, 0.02, 0.01, 0.005}, {10, 20, 40}

local cases = {}
for _, ratio in ipairs(ratios) do cases[#cases + 1] = { divisions = 10, thickness_ratio = ratio } end
for _, n in ipairs(divisions) do
  for _, ratio in ipairs{0.01, 0.005} do
    if n > 10 then cases[#cases + 1] = { divisions = n, thickness_ratio = ratio } end
  end
end
for _, case in ipairs(cases) do case.until_stage = "elastic" end

local top = {} -- mean top displacement by divisions and thickness ratio
for i, result in ipairs(cdem.sweep{ script = "case.lua", set = cases }) do
  if result.exit_code ~= 0 then error("case " .. i .. " ended with exit code " .. result.exit_code) end
  local n = cases[i].divisions
  top[n] = top[n] or {}
  top[n][cases[i].thickness_ratio] = result.figures.elastic_top_uy_mean_m or fine -- nil where it was only checked
end

-- The error is linear in L/h, so two values give the limit without joints: the star mesh's own answer.
local function limit(n) return 2 * top[n][0.005] - top[n][0.01] end

local figures, x, y = {}, {}, {}
for i, ratio in ipairs(ratios) do
  x[i], y[i] = ratio, math.abs(top[10][ratio] / limit(10) - 1)
  figures[#figures + 1] = { name = string.format("top_uy_10_blocks_L_over_h_%g_m", ratio), value = top[10][ratio], unit = "m",
                            reference = fine, kind = "fe", source = "fine finite-element mesh, no joints" }
end
for i = 2, #ratios - 1 do -- the last pair would measure the limit against itself
  figures[#figures + 1] = { name = string.format("order_L_over_h_%g_to_%g", ratios[i - 1], ratios[i]),
                            value = math.log(y[i - 1] / y[i]) / math.log(ratios[i - 1] / ratios[i]), reference = 1,
                            kind = "formula", source = "the joints' compliance is linear in L", tolerance = 0.1 }
end
for _, n in ipairs(divisions) do
  figures[#figures + 1] = { name = string.format("top_uy_%d_blocks_no_joints_m", n), value = limit(n), unit = "m",
                            reference = fine, kind = "fe", source = "fine finite-element mesh", tolerance = 0.005 }
end
cdem.report(figures)
cdem.chart{ file = "thickness.png", title = "What the joints' thickness costs", log_x = true, log_y = true,
            x_label = "equivalent thickness over block size, L/h", y_label = "error of the mean top displacement",
            series = { { name = "10 x 10 blocks", x = x, y = y, style = "both" } } }
