-- Figures of a finished case against what is expected of them.
local expect = {}

local failures = {}

local function note(name, value, wish)
  failures[#failures + 1] = string.format("%s = %s, expected %s", name, tostring(value), wish)
end

function expect.between(figures, name, low, high)
  local value = figures[name]
  if type(value) ~= "number" or value < low or value > high then
    note(name, value, string.format("in [%.6g, %.6g]", low, high))
  end
end

function expect.near(figures, name, reference, relative)
  local reach = math.abs(reference) * relative
  expect.between(figures, name, reference - reach, reference + reach)
end

function expect.equal(figures, name, wish)
  if figures[name] ~= wish then note(name, figures[name], tostring(wish)) end
end

-- Ends the script with an error that lists everything that missed.
function expect.done()
  if #failures > 0 then error(table.concat(failures, "; "), 2) end
end

return expect
