-- Sixteen blocks that topple and slide on a stepped base: Goodman and Bray 1976 (Toppling of rock slopes), with the numbers
-- of Hoek and Bray's book. The friction that is just enough follows from the top block down, by limit equilibrium.
--
--   ./cdem run examples/slope_stability/toppling.lua [--set safety=1.3]
local cdem = require "cdem"

local wanted = cdem.parameter{ name = "safety", default = 1.2, range = {1, 3}, doc = "tan(phi) over the least that holds" }
local tolerance = cdem.parameter{ name = "tolerance", default = 0.02, range = {0.001, 0.2} }
local n_blocks, crest, width, depth = 16, 10, 10, 10 -- the crest is that of the tenth block from the toe; m
-- m: rise of a block over the next one, fall behind the crest, step of the base
local a1, a2, step, lean = 5.0, 5.2, 1.0, math.rad(30)
local weight = 25e3 -- N/m3

local function height(n) return n <= crest and n * (a1 - step) or crest * (a1 - step) - (n - crest) * (a2 + step) end

-- Force at the toe: each block hands down what it needs so as not to topple, or not to slide, the larger of both.
local function toe_force(t) -- t: tan(phi)
  local force = 0
  for n = n_blocks, 1, -1 do
    local y = height(n)
    local W = weight * width * y
    local M = n < crest and y or y - a2 -- arm of the force from above
    local L = n > crest and y or y - a1 -- of the force handed on
    local slides = force - W * (math.cos(lean) * t - math.sin(lean)) / (1 - t * t)
    local topples = L > 0 and (force * (M - width * t) + W / 2 * (y * math.sin(lean) - width * math.cos(lean))) / L or 0
    force = math.max(slides, topples, 0)
  end
  return force
end

local low, high = 0.5, 1
for _ = 1, 50 do
  local middle = 0.5 * (low + high)
  if toe_force(middle) > 0 then low = middle else high = middle end
end

-- The base lies level and gravity leans.
local steps, columns = {}, {}
for n = 1, n_blocks do
  steps[n] = cdem.box{ size = {width, depth, n * step + 5}, origin = {n * width, 0, -5} }
  columns[n] = cdem.box{ size = {width, depth, height(n)}, origin = {n * width, 0, n * step} }
end
local rock = cdem.elastic{ youngs_modulus = 1e10, poissons_ratio = 0.2, density = weight / 9.81 }
local joint = cdem.coulomb{ friction_angle = math.deg(math.atan(wanted * high)) }
local model = cdem.model{ bodies = {
  { name = "base", shape = cdem.merge{ shapes = steps }, material = rock, joint = cdem.glued{} },
  { name = "blocks", shape = cdem.merge{ shapes = columns }, material = rock, joint = joint } },
  contacts = { { "base", "blocks", joint } } }
model:fix{ on = "base" }
model:fix{ on = {"y-", "y+"}, axes = "y" }
model:gravity{ vector = {-9.81 * math.sin(lean), 0, -9.81 * math.cos(lean)} }
model:relax{ residual = 1e-5 }

local safety = cdem.factor_of_safety{ model = model, reduce = {"joints"}, lower = 0.8 * wanted, upper = 1.4 * wanted,
                                      tolerance = tolerance, picture = "toppling.png" }
cdem.report{ { name = "tan_phi_that_just_holds", value = high, reference = 0.7855, kind = "paper", tolerance = 0.002,
               source = "Hoek and Bray, Rock slope engineering" },
             { name = "factor_of_safety", value = safety.factor, reference = wanted, kind = "formula", tolerance = 0.03,
               source = "Goodman and Bray 1976, limit equilibrium" },
             { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } }
