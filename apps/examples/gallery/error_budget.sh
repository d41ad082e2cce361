# An error budget
# At most half of an 8-bit code may be wrong; halflit chooses the cheapest way, and float64 confirms the promise.
halflit render lights:64 fast.png --size 480x360 --shadows off --max-error 0.5 --report fast.json
halflit render lights:64 truth.png --size 480x360 --shadows off --accuracy reference
halflit diff truth.png fast.png --max 1
