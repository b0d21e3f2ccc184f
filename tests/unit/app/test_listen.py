"""How the server ends."""

import asyncio
import socket
import threading

from recon4_app.network.listen import AnnouncingServer, uvicorn_config


async def endless(scope, receive, send):
    assert scope["type"] == "http"
    await send({"type": "http.response.start", "status": 200, "headers": []})
    while True:
        await send({"type": "http.response.body", "body": bytes(1 << 16), "more_body": True})


def test_who_takes_nothing_is_hung_up_on_when_the_server_ends():
    ready = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = listener.getsockname()
        server = AnnouncingServer(uvicorn_config(endless), ready.set)
        thread = threading.Thread(target=lambda: asyncio.run(server.serve([listener])))
        thread.start()
        assert ready.wait(20.0)
        with socket.create_connection(address, timeout=5.0) as client:
            client.sendall(b"GET / HTTP/1.1\r\nHost: here\r\n\r\n")
            client.recv(1)
            server.should_exit = True
            thread.join(20.0)

            assert not thread.is_alive()
            assert ends(client)


def ends(client):
    """Whether the connection comes to an end, after what was on its way."""
    try:
        while client.recv(1 << 20):
            pass
    except TimeoutError:
        return False
    except ConnectionResetError:
        pass
    return True
