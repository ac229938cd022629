/** The scenarios that were requested of the server: each request ends, also if the connection is lost. */
export class Exports {
  private waiting: { resolve(text: string): void; reject(reason: Error): void }[] = [];

  /** The next text of the server; `request` returns whether the request was sent. */
  next(request: () => boolean): Promise<string> {
    return new Promise((resolve, reject) => {
      if (request()) this.waiting.push({ resolve, reject });
      else reject(new Error(lost));
    });
  }

  received(text: string): void {
    this.waiting.shift()?.resolve(text);
  }

  /** Ends all requests without a scenario. */
  fail(reason = lost): void {
    for (const each of this.waiting.splice(0)) each.reject(new Error(reason));
  }
}

const lost = "The scenario could not be exported, because the connection is lost.";
