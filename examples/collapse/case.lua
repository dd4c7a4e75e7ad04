-- A heap of Voronoi blocks and a row of bricks are pushed off a ledge. They land on a floor and on two armour units, and
-- come to rest; none passes through, and energy is kept.
--
--   ./cdem run examples/collapse/case.lua [--set blocks=60]
local cdem = require "cdem"
local scene = require "scene"

local fall = cdem.parameter{ name = "fall", default = 1.0, range = {0, 100}, unit = "s", doc = "without damping" }
local rest = cdem.parameter{ name = "rest", default = 5.0, range = {0, 100}, unit = "s",
                             doc = "at most, with local damping, afterwards" }
local safety = cdem.parameter{ name = "safety", default = 0.8, range = {0.01, 1}, doc = "time step over the stable one" }
local every = cdem.parameter{ name = "every", default = 0.05, range = {1e-3, 10}, unit = "s", doc = "between pictures" }

local model = scene.model()
model:fix{ on = scene.held }
model:gravity{ vector = {0, 0, -9.81} }

local frames, next_frame = {}, every
local function film()
  if model.time < next_frame - 1e-9 then return end
  next_frame = next_frame + every
  frames[#frames + 1] = scene.draw(model, string.format("frames/fall_%03d.png", #frames + 1))
end

-- The pusher starts softly: one that starts at full speed throws stiff blocks forward at twice its speed.
local step, undamped = 0.025, 0
for i = 1, math.floor(fall / step + 0.5) do
  local time = (i - 1) * step
  model:fix{ on = "pusher", velocity = {time > 0.55 and 0 or 2 * math.min(1, time / 0.2), 0, 0} }
  model:run{ duration = step, safety = safety }
  undamped = math.max(undamped, model:energy().balance_error)
  film()
end
local at_rest
if rest > 0 then
  at_rest = model:settle{ max_time = rest, local_damping = 0.3, safety = safety, every = 500, callback = film }.converged
end
if #frames > 0 then cdem.film{ file = "fall.ogv", frames = frames, frames_per_second = 10 } end
scene.draw(model, "rest.png")
model:save{ file = "rest.vtu" }
scene.report(model, { undamped = undamped, at_rest = at_rest })
