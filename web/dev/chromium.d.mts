/** The browser for tests, benchmark and pictures. */
export const launchOptions: { executablePath: string; args: string[] };
