"""Write joint angles and a servo's temperature to a Parquet file: stream_to_parquet.py PORT FILE.

An optional third argument sets the duration in seconds (default: 10). Each row has the time at
which its last reply was read. The file is readable in pandas, polars and DuckDB:
duckdb -c "select * from 'angles.parquet'". Needs: pip install 'cobotwire[arrow]'.
"""

import sys

import pyarrow as pa
import pyarrow.parquet as pq

from cobotwire import MyCobot280, Sample
from cobotwire.editions.mycobot280 import GetAngles, GetServoTemps

RATE = 20.0  # samples a second
BLOCK = 100  # rows that are written at once
JOINTS = [f"j{number}" for number in range(1, 7)]
SCHEMA = pa.schema(
    [("time", pa.float64()), *((joint, pa.float64()) for joint in JOINTS), ("hottest", pa.int64())]
)


def main(port: str, file: str, seconds: float = 10.0) -> int:
    """Stream for some seconds; return the number of rows."""
    rows = 0
    block: list[dict[str, float]] = []
    with MyCobot280(port) as arm, pq.ParquetWriter(file, SCHEMA) as writer:
        # Times are relative to the first row; time.monotonic() has an arbitrary start.
        start: float | None = None
        with arm.stream(GetAngles(), GetServoTemps(), rate=RATE) as stream:
            for sample in stream:
                start = sample.replied_at if start is None else start
                block.append(row(sample, start))
                over = sample.period >= seconds * RATE
                if over or len(block) == BLOCK:
                    writer.write_table(pa.Table.from_pylist(block, SCHEMA))
                    rows += len(block)
                    block.clear()
                if over:
                    break
        print(stream.report)
    return rows


def row(sample: Sample, start: float) -> dict[str, float]:
    """Return one row of the file."""
    angles = sample[GetAngles()]._asdict()
    hottest = max(sample[GetServoTemps()])
    return {"time": sample.replied_at - start, **angles, "hottest": hottest}


if __name__ == "__main__":
    print(main(sys.argv[1], sys.argv[2], *map(float, sys.argv[3:])), "rows")
