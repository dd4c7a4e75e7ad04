-- exit code: 2
-- says: os.execute: not available
-- says: --unsafe

os.execute("touch caught") -- wrong
