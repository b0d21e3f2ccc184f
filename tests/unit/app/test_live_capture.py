"""The server's side of a capture, with a mapper that sends a few messages."""

import asyncio

from recon4.errors import CorruptFile
from recon4.live.protocol import Done, encode
from recon4.live.session import CaptureSession
from recon4.locales.coded import StoredText, said, text_of
from recon4_app.live.capture import Capture, unfinished
from tests.live_messages import pose

POSE = pose()
DONE = Done(frames=3, problem="")


def followed(session, connections):
    """A capture whose mapper sent the messages of each connection, and ended."""
    coming = iter(connections)

    async def serve(reader, writer):
        for message in next(coming):
            writer.write(encode(message))
        writer.close()

    async def run():
        capture = Capture(session)
        async with await asyncio.start_unix_server(serve, session.socket("mapper")):
            await capture.follow()
            while not capture.over:
                await capture.stream.news(capture.stream.version, timeout_s=0.1)
            await capture.leave()
        return capture

    return asyncio.run(run())


def test_why_there_is_no_map_is_said_in_the_language_of_who_looks(tmp_path):
    session = CaptureSession(project=tmp_path / "walk")
    session.folder.mkdir(parents=True)
    session.outcome.write_text('{"why": "stopped"}')
    why = StoredText.of(text_of(CorruptFile("walk.pcap: cut")))
    ended = Done(frames=0, problem=why.text, code=why.code, values=why.values)

    (problem,) = followed(session, [[ended]]).problems

    assert said(problem, "de") == said(text_of(CorruptFile("walk.pcap: cut")), "de") != problem


def test_a_server_reconnects_to_its_mapper_and_starts_no_second_one(tmp_path):
    session = CaptureSession(project=tmp_path / "walk")
    connections = iter([[POSE], [POSE], [POSE, DONE]])
    session.folder.mkdir(parents=True)
    session.outcome.write_text('{"why": "stopped"}')

    capture = followed(session, connections)

    assert next(connections, None) is None
    assert capture.problems == ()
    assert not (session.folder / "mapper.txt").exists()


def test_a_mapper_that_started_after_all_is_no_problem_any_more(tmp_path):
    session = CaptureSession(project=tmp_path / "walk")
    session.folder.mkdir(parents=True)
    session.outcome.write_text('{"why": "stopped"}')
    seen = asyncio.Event()

    async def serve(reader, writer):
        writer.write(encode(POSE))
        await seen.wait()
        writer.write(encode(DONE))
        writer.close()

    async def run():
        capture = Capture(session)
        capture.problems = ("the mapper did not start",)
        async with await asyncio.start_unix_server(serve, session.socket("mapper")):
            await capture.follow()
            while capture.stream.version == 0:
                await capture.stream.news(0, timeout_s=0.1)
            while_mapping = capture.problems
            seen.set()
            while not capture.over:
                await capture.stream.news(capture.stream.version, timeout_s=0.1)
            await capture.leave()
        return while_mapping

    assert asyncio.run(run()) == ()


def test_a_capture_whose_recorder_never_ran_is_not_taken_up(tmp_path):
    begun, never = (
        CaptureSession(project=tmp_path / "begun"),
        CaptureSession(project=tmp_path / "never"),
    )
    for session in (begun, never):
        session.save()
    begun.capture.parent.mkdir()
    begun.capture.touch()

    assert unfinished(tmp_path) == [begun.project]
